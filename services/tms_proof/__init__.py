"""Whether a machine was seen to stand, and whether it follows its commands: from what it tells of itself.

Pure logic, for the decisions of the gateway and for the simulation of a site. Times are monotonic seconds.
"""
