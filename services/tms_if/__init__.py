"""Borders to other stacks: the TCP bridge that OperaSim-PhysX connects to. Mapping only, no decisions."""
