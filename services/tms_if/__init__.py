"""Connects other stacks: the TCP bridge for OperaSim-PhysX. It maps messages only and decides nothing."""
