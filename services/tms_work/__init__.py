"""Work as numbers: cycles of machines and their sums by run, machine, hour and day. No ROS, no clock."""
