"""What machines look like, for eyes only: their solids, and the same as a URDF."""
