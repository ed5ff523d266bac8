"""The catalogue of what machines can do: one file a subtask."""
