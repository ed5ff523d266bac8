"""Records that several subtasks read."""
