"""The gateway of one machine: who may move it, when it is stopped, and whether it was seen to stand."""
