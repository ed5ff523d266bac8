"""Shared places as the API sees them: told by tms:db, and taken from their holders there."""

from tms_msg_areas.msg import Places
from tms_msg_areas.srv import RevokePlace

from tms_machine.asking import ask
from tms_ros.node import Ros
from tms_ur import messages
from tms_ur.board import Board

LIMIT = 4.0  # s for an answer of tms:db


class PlaceClient:
    """The keeper of shared places."""

    def __init__(self, ros: Ros, board: Board) -> None:
        self._ros = ros
        ros.subscribe(Places, "/tms/places", lambda told: board.put_shared(messages.shared_places(told)), latched=True)

    def revoke(self, place: str, who: str) -> str:
        """Take a place from its holder, which is returned.

        Raises:
            RosError: nobody holds it, or tms:db is away.
        """
        return ask(
            self._ros, RevokePlace, "/tms/places/revoke", RevokePlace.Request(place=place, who=who), LIMIT
        ).holder
