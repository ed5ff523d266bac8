"""TMS_SP: what sensing PCs measure becomes parameter records."""
