"""Soil and ground as numbers: what bodies of machines do to the ground, and what it does to them. Pure logic."""
