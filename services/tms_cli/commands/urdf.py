"""`tms urdf`: a machine as a ROS 2 package with URDF and meshes."""

from pathlib import Path

import click

from tms_cli import new_file, session
from tms_cli.words import say


@click.command()
@click.argument("machine")
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="Default: MACHINE_description.zip."
)
@click.option("--overwrite", is_flag=True, help="Replace a file that is there already.")
@session.json_option
def command(machine: str, output: Path | None, overwrite: bool, as_json: bool) -> None:
    """Write a machine of the site as a ROS 2 package: URDF, and meshes of the shapes that the console shows.

    For RViz, Foxglove and MoveIt. The joints are named as in the machine's /joint_states; its file tells no torques.
    Unpack it in a colcon workspace, or give its URDF to robot_state_publisher.

    \b
    Examples:
      tms urdf zx200
      tms urdf ic120 --output ic120.zip
    """
    from tms_shapes.package import package

    session.machines((machine,), False)
    site = session.site()
    file = output or Path(f"{machine}_description.zip")
    data = package(machine, site.model_of(machine), site.border(machine))
    new_file.write(file, data, overwrite)
    if as_json:
        session.show_json({"file": str(file), "machine": machine, "bytes": len(data)})
    else:
        click.echo(say("{file}: {machine} as a ROS 2 package", file=file, machine=machine))
