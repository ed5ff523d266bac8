"""Decides about motion: pure state machines, the same in the processes and in the simulation of a site.

Nothing here knows a thread, a clock, a file or ROS. A shell in a service turns what happens into events and the effects
of a step into calls. Times are monotonic seconds of the PC that decides.
"""

STOP_PROVEN = 10.0  # s within which a gateway sees that a machine stands, or reports that it does not
RECEIPT_LIMIT = STOP_PROVEN + 3.0  # s without a receipt after which a gateway counts as silent
DISK_LIMIT = 1.0  # s more for the disk; then the answer does not wait for it any longer
