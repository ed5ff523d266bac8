"""One file a verb; the file name is the verb, `_` for `-`."""
