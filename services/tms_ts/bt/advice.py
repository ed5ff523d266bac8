"""Preflight: what the author should know before a run, found without running anything.

Mostly the places where this engine is kinder than the C++ system, which would hang or throw there.
"""

from __future__ import annotations

from collections.abc import Mapping

from tms_ts.bt.blackboard_nodes import SetBlackboard
from tms_ts.bt.convert import CPP_NAMES, FROM_TEXT, MISSING
from tms_ts.bt.node import AtOnce, Node


def advise(nodes: list[Node]) -> None:
    """Add the warnings of all nodes to their tree; `nodes` is in pre-order."""
    at_once: dict[Node, AtOnce] = {}
    for node in reversed(nodes):  # children before their parents
        at_once[node] = node.at_once([at_once[child] for child in node.children])
    texts = text_keys(nodes)
    for node in nodes:
        for note in (*literals(node), *node.preflight(texts)):
            node.warn(note)
        if node.may_hang([at_once[child] for child in node.children]):
            node.warn(
                f"{node.registration_name} is endless and what is in it can complete at once: the C++ system can hang "
                "here; this engine goes on at the next tick"
            )


def text_keys(nodes: list[Node]) -> Mapping[str, str]:
    """Keys that a SetBlackboard gives a text, with the text."""
    found: dict[str, str] = {}
    for node in nodes:
        if isinstance(node, SetBlackboard):
            key, value = node.literal("output_key"), node.literal("value")
            if key is not None and value is not None:
                found[key] = value
    return found


def literals(node: Node) -> list[str]:
    """Port texts that do not fit the port's type, and ports that the node cannot do without."""
    notes = [f"{node.registration_name} needs {port!r}, it throws when ticked" for port in node.needs
             if port not in node.bindings and node.ports[port].default is MISSING]  # fmt: skip
    for port, bound in node.bindings.items():
        kind = node.ports[port].kind
        if isinstance(bound, str) and FROM_TEXT[kind](bound) is MISSING:
            notes.append(f"{port}={bound!r} of {node.registration_name} is not of type {CPP_NAMES[kind]}")
    return notes
