"""Finds the topics of a recording that go into sensing inputs, and why the others do not."""

import importlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tms_cli.reasons import EmptyRecording, NoSuchTopic, NothingToPlay
from tms_cli.replay.recording import Track
from tms_config.config import Site
from tms_config.models import Border
from tms_machine.sensing import Input, sensing_path
from tms_reason.errors import TmsError
from tms_reason.validation import Wrong
from tms_sensors.message_types import message_class


@dataclass
class Matches:
    """The topics to play, and for others why they are not played, or are played with a warning."""

    played: dict[Track, Input] = field(default_factory=dict)
    skipped: dict[str, str] = field(default_factory=dict)
    doubts: dict[str, str] = field(default_factory=dict)


def match(tracks: Sequence[Track], inputs: Mapping[str, Input], site: Site, wanted: Sequence[str]) -> Matches:
    """Find the inputs of the tracks; `wanted` are topics, and empty means all of the recording.

    Raises:
        TmsError: BAD_TOPIC, a wanted topic is not in the recording; NOTHING_TO_PLAY.
    """
    chosen = _chosen(tracks, wanted)
    by_topic: dict[str, list[tuple[str, Input]]] = {}
    for name, given in inputs.items():
        by_topic.setdefault(_full(given.topic), []).append((name, given))
    machines = _topics_of_machines(site)
    found = Matches()
    for track in chosen:
        takers = by_topic.get(track.topic, [])
        why = _why_not(track, takers, machines, site)
        if not why and track.topic in {other.topic for other in found.played}:
            why = "recorded with several types: the first one is played"
        if why:
            found.skipped[track.topic] = why
            continue
        found.played[track] = next(given for _, given in takers if given.type == track.type)
        if not track.hash:
            text = f"the recording does not tell how {track.type} was laid out: it is read as installed here"
            found.doubts[track.topic] = text
    if not found.played:
        reported = tuple(f"{topic}: {why}" for topic, why in found.skipped.items())
        raise TmsError(NothingToPlay(reported) if reported else EmptyRecording(), "NOTHING_TO_PLAY")
    return found


def _chosen(tracks: Sequence[Track], wanted: Sequence[str]) -> Sequence[Track]:
    there = {track.topic for track in tracks}
    missing = [topic for topic in map(_full, wanted) if topic not in there]
    if missing:
        raise TmsError(NoSuchTopic(tuple(missing), tuple(sorted(there))), "BAD_TOPIC")
    return [track for track in tracks if not wanted or track.topic in map(_full, wanted)]


def _why_not(track: Track, takers: Sequence[tuple[str, Input]], machines: Mapping[str, str], site: Site) -> str:
    if not takers:
        return f"no input of {sensing_path(site).name} takes it"
    if track.topic in machines:
        return f"{machines[track.topic]} itself speaks there: its gateway would take the recording for the machine"
    if track.type not in {given.type for _, given in takers}:
        return f"recorded as {track.type}, but " + ", ".join(f"input {name} takes {one.type}" for name, one in takers)
    try:
        message_class(track.type)
    except Wrong as error:
        return str(error)
    here = built_hash(track.type)
    if track.hash and here and track.hash != here:
        return f"recorded with another definition of {track.type} ({track.hash[:15]}..., here {here[:15]}...)"
    return ""


def _topics_of_machines(site: Site) -> dict[str, str]:
    """Topics at the border of the site's machines, with the machine."""
    return {f"/{machine}/{topic}": machine for machine in site.file.machines for topic in _topics(site.border(machine))}


def _topics(border: Border) -> list[str]:
    sources = [getattr(border, name) for name in border.sources]
    commands = (border.cmd_vel, border.emg_stop, border.joint_cmd, *border.joint_angles.values())
    return [topic for topic in (*sources, *commands) if topic]


def built_hash(name: str) -> str:
    """Hash of the type that is installed here; "" where the installation has none."""
    package, kind, word = name.split("/")
    home = importlib.import_module(package).__file__  # PREFIX/lib/pythonX.Y/site-packages/PACKAGE/__init__.py
    assert home is not None, f"{package} is no package with a file"
    file = Path(home).parents[4] / "share" / package / kind / f"{word}.json"
    if not file.exists():
        return ""
    rows: list[dict[str, Any]] = json.loads(file.read_text(encoding="utf-8"))["type_hashes"]
    return next((str(row["hash_string"]) for row in rows if row["type_name"] == name), "")


def _full(topic: str) -> str:
    return topic if topic.startswith("/") else f"/{topic}"
