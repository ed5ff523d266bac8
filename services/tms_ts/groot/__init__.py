"""Groot as monitor: publishers for Groot 1 and Groot 2 that only read the tree of a run."""
