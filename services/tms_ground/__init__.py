"""The ground of a site: its origin, its area, the files that its heights come from, and the process that keeps it."""
