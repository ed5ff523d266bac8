"""Process `<machine>:mc`: moves joints and tracks where a machine, or a simulator, has no controllers of its own.

It serves the actions of the machine's border, and is a dead man: it moves nothing without the machine's gateway.
"""
