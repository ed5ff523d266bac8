"""Custom nodes, one file each; the file list is the catalogue."""
