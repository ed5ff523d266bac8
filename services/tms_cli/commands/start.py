"""`tms start`: start one process."""

from tms_cli.control import control_command

command = control_command(
    "start",
    """Start one process; a part of the name is enough when only one has it.

    \b
    Examples:
      tms start change_pose
      tms start zx200:rc
    """,
)
