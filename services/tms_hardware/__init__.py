"""What a machine's own hardware tells of itself, and what follows from that: pure. No protective device."""
