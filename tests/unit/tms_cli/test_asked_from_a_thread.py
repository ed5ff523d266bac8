"""A scheduler is asked by the drill's workers, too, which have no command of click around them."""

from types import SimpleNamespace
from typing import Any

from tms_msg_ts.srv import CancelRun

from tms_cli import session
from tms_config.config import load_site


def test_the_scheduler_of_a_site_is_asked_without_a_command() -> None:
    asked: list[tuple[str, str]] = []

    def call(_: Any, name: str, request: CancelRun.Request, __: float) -> CancelRun.Response:
        asked.append((name, request.run_id))
        return CancelRun.Response()

    node: Any = SimpleNamespace(call=call)
    session.of_any(node, load_site(), CancelRun, "abandon_run", "NO_RUN", run_id="r")
    assert asked == [("/tms/abandon_run", "r")]
