"""The catalogue of subtasks that machines can run: one file a subtask."""
