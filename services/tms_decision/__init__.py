"""Decides about motion: pure state machines, the same in the processes and in the simulation of a site.

Nothing here knows a thread, a clock, a file or ROS. A shell in a service turns what happens into events and the effects
of a step into calls. Times are monotonic seconds of the PC that decides.
"""
