"""Soil and ground as numbers: pure."""
