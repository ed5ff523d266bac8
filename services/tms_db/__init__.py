"""The database module: the only process that opens MongoDB."""
