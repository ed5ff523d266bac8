"""Machines: border, leases, permit, geometry, and the kit of those who write subtasks."""
