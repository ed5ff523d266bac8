"""The stand-in for a machine: it has the same ROS names and types, and computes the motion of the hydraulics."""
