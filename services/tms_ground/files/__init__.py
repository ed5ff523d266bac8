"""Files of heights: a reader a format, and what all have in common."""
