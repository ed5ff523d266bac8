"""Machines: border, permit, fencing, geometry, places, and what people write of them."""
