"""`tms restart`: restart one process."""

from tms_cli.control import control_command

command = control_command(
    "restart",
    """Restart one process; a part of the name is enough when only one has it.

    \b
    Examples:
      tms restart change_pose
      tms restart zx200:rc
    """,
)
