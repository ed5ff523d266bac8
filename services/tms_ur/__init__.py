"""HTTP API and console of the site."""
