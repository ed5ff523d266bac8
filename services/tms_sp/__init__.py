"""TMS_SP: writes the measurements of sensing PCs into parameter records."""
