"""Machines: border, permit, geometry, and the kit of those who write subtasks."""
