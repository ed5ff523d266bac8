"""Site, machines, processes, PCs: everything that reads `configs/`. No ROS."""
