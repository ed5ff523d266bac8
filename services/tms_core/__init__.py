"""The shared library of all services: configuration, process table, ROS wrapper, subtask base."""
