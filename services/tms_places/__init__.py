"""Shared places: who holds which release area, who waits for it, and the leases of gateways: pure."""
