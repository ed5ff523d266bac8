"""Processes of one PC: supervisord on one side, ROS on the other."""
