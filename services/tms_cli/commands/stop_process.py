"""`tms stop-process`: stop one process (a machine is stopped by `tms stop`)."""

from tms_cli.control import control_command

command = control_command(
    "stop",
    """Stop one process until it is started again; this is not the way to stop a machine.

    \b
    Example:
      tms stop-process zx200:subtask_zx200_change_pose
    """,
)
