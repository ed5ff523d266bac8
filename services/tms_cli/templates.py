"""Texts of templates for verbs that draw or check trees, from the database of the running mesh."""

from typing import TYPE_CHECKING

from tms_cli import session
from tms_reason.errors import TmsError

if TYPE_CHECKING:
    from tms_ros.node import Ros


def text_of(node: "Ros", name: str) -> str | None:
    """The text of a stored template; None if there is none of this name.

    Raises:
        TmsError: the database does not answer, or refuses.
    """
    from tms_msg_db.srv import GetTemplate

    try:
        return session.call(node, GetTemplate, "/tms/db/get_template", template_name=name).stored.task_sequence
    except TmsError as error:
        if error.code == "TEMPLATE_MISSING":
            return None
        raise
