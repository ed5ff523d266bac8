"""Entry of `python -m operasim`."""

from operasim.program import main

main(prog_name="operasim")
