"""The daily report: its facts, its tables, plots and map, and the same as HTML and as PDF."""
