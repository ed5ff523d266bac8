"""The program: options, log, signals."""

import signal
from typing import Any, get_args

import click
import structlog

from operasim.messages import Layout
from operasim.model import FileError, Unknowns, scene, scenes
from operasim.simulator import Settings, Simulator

HELP = """A stand-in of OperaSim-PhysX that needs no Unity: it connects to a ROS-TCP endpoint as the simulator does.

\b
Examples:
  python -m operasim                                  # SimpleScene, to an endpoint on this PC
  python -m operasim --scene AllMachines --control-port 10001
  python -m operasim --scene my_scene.yaml --yaw-gain 0.33 --lag 1.3 --dead-time 50
  echo "speed 0.5" | nc -N 127.0.0.1 10001            # half as fast as real time
  echo "state" | nc -N 127.0.0.1 10001                # where all machines really are, as JSON

\b
Commands of the control port, a line each; the answer is the state:
  state         nothing but the answer
  pause         no frames; the connection stays
  resume        go on
  speed 0.5     simulated seconds a second; 0: the time stands still, frames go on
  cut 3         lose the connection, connect again after 3 s
  restart 2     end, start again after 2 s: from time 0, at the first places
"""


def _log() -> Any:  # structlog's loggers have the methods of their wrapper class
    """A line per event, at once."""
    renderer = structlog.processors.LogfmtRenderer(key_order=["timestamp", "event"])
    stamper = structlog.processors.TimeStamper(fmt="iso")
    wrapper = structlog.make_filtering_bound_logger(0)
    return structlog.wrap_logger(structlog.PrintLogger(), processors=[stamper, renderer], wrapper_class=wrapper)


@click.command(help=HELP, context_settings={"show_default": True})
@click.option("--scene", "scene_name", default="SimpleScene", help=f"{', '.join(scenes())}, or a file *.yaml")
@click.option("--host", default="127.0.0.1", help="where the endpoint is")
@click.option("--port", type=click.IntRange(1, 65535), default=10000)
@click.option(
    "--layout", type=click.Choice(get_args(Layout)), default="plain", help="of JointCmd; the simulator's is plain"
)
@click.option("--fps", type=click.FloatRange(1, 1000), default=60.0, help="frames a second")
@click.option(
    "--jitter",
    type=click.FloatRange(0, 0.9),
    default=0.3,
    help="how early or late frames come, as a part of their time",
)
@click.option("--speed", type=click.FloatRange(0, 20), default=1.0, help="simulated seconds a second")
@click.option("--yaw-gain", type=float, default=0.6, help="true yaw rate, as a part of what the wheels give: 0.33 to 1")
@click.option("--kick", type=float, default=0.08, help="rad that the base turns per rad/s that the swing gains")
@click.option("--droop", type=float, default=1.0, help="factor of gravity at joints")
@click.option("--lag", type=float, default=1.0, help="factor of the lags of joints")
@click.option("--dead-time", type=float, default=0.0, help="ms added to dead times")
@click.option("--seed", type=int, default=0, help="of frame times and of the order of registrations")
@click.option(
    "--control-port", type=click.IntRange(0, 65535), default=None, help="loopback; 0: any, the log says which"
)
def main(
    scene_name: str, host: str, port: int, layout: Layout, fps: float, jitter: float, speed: float, seed: int,
    control_port: int | None, **unknowns: Any,
) -> None:  # fmt: skip
    """Run until SIGTERM or SIGINT."""
    log = _log()

    def event(name: str, **fields: object) -> None:
        log.info(name, **fields)

    try:
        known = Unknowns(**unknowns | {"dead_time": unknowns["dead_time"] / 1000})
        settings = Settings(scene(scene_name), known, (host, port), layout, fps, jitter, speed, seed, control_port)
        simulator = Simulator(settings, event)
    except (FileError, ValueError) as error:
        raise click.UsageError(str(error)) from error
    except OSError as error:
        raise click.UsageError(f"control port {control_port}: {error.strerror}") from error
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: simulator.end())
    event("started", scene=scene_name, machines=",".join(settings.scene.machines), seed=seed)
    simulator.run()
    event("ended")
