"""Machines: border, leases, permit, geometry, and the interface for authors of subtasks."""
