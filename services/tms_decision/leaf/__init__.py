"""The leaf goals of a run: when one is sent, when it counts as lost, when it is sent again, and when it is given up."""
