"""Several schedulers of one site: which machines are whose, leases of machines, and how clients find a run."""
