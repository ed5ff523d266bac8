"""Functions for all verbs: the site, a short-lived ROS node, typed service calls, output for people and programs."""

import json
import math
import os
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING, Any

import click

from tms_config.config import Site, load_site
from tms_config.reasons import NoMachine
from tms_interfaces.generated import M, Reply, Req, ServiceType
from tms_reason import wire
from tms_reason.errors import ConfigError, TmsError
from tms_reason.names import check_sent
from tms_reason.reason import Foreign
from tms_runtime import environment, state_folder
from tms_runtime.priority import undisturbed
from tms_schedulers import asking

if TYPE_CHECKING:
    from tms_msg_ts.msg import RunStates

    from tms_ros.node import Ros

CALL_LIMIT = 10.0  # s; on a full PC, discovery of a process that is there has taken more than 5
LATCHED_LIMIT = 5.0  # s for the latched state of a module to arrive
leaving = ExitStack()  # leaves the ROS graph; closed at the end of this process, since DDS sometimes hangs there


def site() -> Site:
    """The site that the user chose with --site or TMS_SITE."""
    return load_site(click.get_current_context().find_root().obj)


@contextmanager
def ros() -> Iterator["Ros"]:
    """A node for the length of one command; rclpy is imported only by verbs that need it."""
    environment.enter(site())
    from tms_ros.node import Ros

    with state_folder.private():  # rclpy writes a log of its own
        node = Ros(f"tms_cli_{os.getpid()}", creating=undisturbed())
    leaving.callback(node.leave)
    try:
        yield node
    finally:
        node.stop()


def machines(names: tuple[str, ...], every: bool) -> list[str]:
    """The machines that a user has named, or all machines of the site.

    Raises:
        ConfigError: the site does not have one of them; UsageError: none is named.
    """
    known = site().file.machines
    if every and not names:
        return list(known)
    if every or not names:
        raise click.UsageError("name a machine, or give --all")
    for name in names:
        if name not in known:
            raise ConfigError(NoMachine(name, tuple(known)))
    return list(names)


def call(
    node: "Ros", service_type: ServiceType[Req, Reply], name: str, *, seconds: float = CALL_LIMIT, **fields: Any
) -> Reply:
    """Call a service of ours; an error in its answer is raised.

    Raises:
        TmsError: the service refused, does not exist, or did not answer; or a text would be cut on the way.
    """
    request_type: Any = service_type.Request
    request: Req = request_type(**fields)
    check_sent(name, request)
    answer = node.call(service_type, name, request, seconds)
    if answer.error_code:
        raise TmsError(wire.of(answer.error_msg) or Foreign(answer.error_code), answer.error_code)
    return answer


def latched(node: "Ros", message_type: type[M], topic: str) -> M | None:
    """The state on a latched topic of a module; None if none arrives within LATCHED_LIMIT."""
    received: list[M] = []
    there = threading.Event()

    def receive(message: M) -> None:
        received.append(message)
        there.set()

    node.subscribe(message_type, topic, receive, latched=True)
    return received[-1] if there.wait(LATCHED_LIMIT) else None


def of_any(
    node: "Ros", where: Site, service_type: ServiceType[Req, Reply], name: str, unknown: str, **fields: Any
) -> Reply:
    """Call a service of the scheduler that knows what is asked; the others refuse with the code `unknown`.

    Raises:
        TmsError: as `call`.
    """
    return asking.of_any(where, lambda one: call(node, service_type, one.named(name), **fields), unknown)


def runs(node: "Ros", seconds: float = LATCHED_LIMIT, wanted: str = "") -> "RunStates | None":
    """The active runs and open questions of all schedulers, as `wait_for_runs` finds them."""
    from tms_schedulers.hearing import wait_for_runs

    return wait_for_runs(node, site(), seconds, wanted)


def show_json(data: Any) -> None:
    """Print the JSON document of --json on stdout."""
    click.echo(json.dumps(_finite(data), ensure_ascii=False, indent=2, allow_nan=False))


def _finite(data: Any) -> Any:
    """Replace NaN and infinity, which JSON does not have, by null, as in the API."""
    if isinstance(data, float):
        return data if math.isfinite(data) else None
    if isinstance(data, dict):
        return {key: _finite(value) for key, value in data.items()}
    return [_finite(part) for part in data] if isinstance(data, (list, tuple)) else data


json_option = click.option("--json", "as_json", is_flag=True, help="One JSON document on stdout.")
