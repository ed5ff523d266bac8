"""One run of a task: it is prepared, ticked, stopped, seen to stand, and ended."""
