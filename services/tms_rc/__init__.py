"""The machine gateway: every motion passes it, and it proves that a stop was a stop."""
