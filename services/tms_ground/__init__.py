"""The ground of a site: its origin, its area, and the files that its heights come from. No ROS."""
