"""Areas of a site, and the law that keeps machines in them: pure. No protective device; claims no conformity."""
