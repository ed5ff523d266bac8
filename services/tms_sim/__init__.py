"""Stand-in for a machine: the same ROS names and types, moved by arithmetic instead of hydraulics."""
