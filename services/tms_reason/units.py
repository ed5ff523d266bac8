"""Units of the fields of records, by the fields' names, which mean the same in every record."""

NAMES = {
    **dict.fromkeys(("x", "y", "z", "goal_x", "goal_y", "goal_z", "offset", "depth", "drag", "lift"), "m"),
    **dict.fromkeys(("area_x", "area_y", "floor", "near", "far", "deepest"), "m"),
    **dict.fromkeys(("volume", "moved", "bank", "before"), "m3"),
    **dict.fromkeys(("theta_w", "target_angle", "goal_position"), "rad"),
    "yaw": "deg",
}
ENDINGS = {"_joint": "rad", "_goal_pos": "deg"}  # angles of joints; the joint samples of the C++ system use degrees


def unit(field: str) -> str:
    """The unit of a field; empty for flags, quaternions, and fields that this system does not use itself."""
    return NAMES.get(field) or next((unit for ending, unit in ENDINGS.items() if field.endswith(ending)), "")
