"""Machines: border, permit, geometry, and the interface for authors of subtasks."""
