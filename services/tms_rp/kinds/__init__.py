"""One module for each kind of machine that plans motions."""
