"""The `tms` command: one file a verb."""
