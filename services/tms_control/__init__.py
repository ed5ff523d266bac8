"""Moves joints and tracks that answer late: control laws, references, and what is learned of a drive on the way.

Pure logic, for the motion controllers and for the stand-ins. Times are seconds of the machine's own clock.
"""
