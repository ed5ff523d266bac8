"""The interface for authors of subtasks, and the process that runs one."""
