"""Reasons as people read them, for tests of texts."""

import re

from tms_reason import texts, wire
from tms_reason.reason import Reason


def words(what: Reason | str | None) -> str:
    """English of a reason, or of the line that carries it; empty for none."""
    reason = wire.of(what) if isinstance(what, str) else what
    return "" if reason is None else texts.text(reason, "en")


ROS = re.compile(r"/zx200/|ABORTED|_action/|follow_joint_trajectory")  # what only ROS knows
COMMAND = re.compile("`[^`]*`")
SENTENCE = re.compile(r"[A-Za-z]{2,}(?:,? [A-Za-z]{2,}){2,}")


def english(text: str) -> list[str]:
    """What reads like an English sentence: three words in a row. Names, units and `commands` are none."""
    return SENTENCE.findall(COMMAND.sub("", text))
