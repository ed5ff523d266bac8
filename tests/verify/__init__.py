"""`make verify`: the verification run of the paper, measured on a zx200 behind OperaSim-PhysX's protocol."""
