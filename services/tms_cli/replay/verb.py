"""The command `tms sensing replay`."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from tms_cli import session
from tms_cli.reasons import BeginsLate
from tms_config.clock import monotonic, sleep
from tms_reason.errors import TmsError

if TYPE_CHECKING:
    from tms_cli.replay.matching import Matches
    from tms_cli.replay.player import Played
    from tms_cli.replay.recording import Recording

SECOND = 1_000_000_000  # ns
Tick = Callable[[int, int], None]  # turn, moment [ns of the recording]


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--speed", type=click.FloatRange(0.01, 1000), default=1.0, help="Times as fast as it was (default: 1).")
@click.option("--topics", multiple=True, metavar="TOPIC", help="Only this topic; may be given several times.")
@click.option("--start", type=click.FloatRange(min=0), default=0.0, metavar="SECONDS", help="Begin there.")
@click.option("--duration", type=click.FloatRange(min=0.001), metavar="SECONDS", help="Play that much of it.")
@click.option("--loop", type=click.IntRange(1, 10_000), default=1, metavar="N", help="Play it N times (default: 1).")
@click.option("--shift-stamps/--keep-stamps", default=True, help="Whether stamps become those of now (default: yes).")
@session.json_option
def replay(
    file: Path, speed: float, topics: tuple[str, ...], start: float, duration: float | None, loop: int,
    shift_stamps: bool, as_json: bool,
) -> None:  # fmt: skip
    """Play a recording (rosbag2: a folder, or a .db3 or .mcap file) into the sensing inputs.

    Topics that are no input of sensing.yaml, or that a machine of the site speaks itself, are left out and named.
    Old stamps are moved to the present unless you say --keep-stamps. Ctrl-C stops.

    \b
    Examples:
      tms sensing replay rosbag2_2026_04_01 --speed 20
      tms sensing replay survey.mcap --topics /terrain/height --start 60 --duration 30
    """
    from tms_cli.replay.recording import Recording

    with Recording(file) as recording, session.ros() as node:
        from tms_cli.replay.matching import match
        from tms_cli.replay.pace import Pace
        from tms_cli.replay.player import LOOP_GAP, Player
        from tms_machine.sensing import load_sensing

        span = _span(recording, start, duration)
        found = match(recording.tracks, load_sensing(session.site()).inputs, session.site(), topics)
        _warn(found)
        player = Player(node, found, keep_stamps=not shift_stamps)
        pace, begun = Pace(span[0], speed), monotonic()
        try:
            with _progress(span, loop) as tick:
                for turn in range(loop):
                    if turn:
                        sleep(LOOP_GAP)
                        pace.restart()
                    player.play(recording, list(found.played), span, pace, partial(tick, turn))
            player.finish()
        except KeyboardInterrupt:
            click.echo(f"stopped after {player.reported.total} messages", err=True)
            raise
        _show(player.reported, found, monotonic() - begun, as_json)


def _span(recording: "Recording", start: float, duration: float | None) -> tuple[int, int]:
    """The span to play: its first moment, and the moment before which it ends (ns).

    Raises:
        TmsError: BAD_START; the recording is shorter.
    """
    first, last = recording.span
    begin = first + round(start * SECOND)
    if begin > last:
        raise TmsError(BeginsLate(str(recording.path), (last - first) / SECOND, start), "BAD_START")
    return begin, last + 1 if duration is None else min(last + 1, begin + round(duration * SECOND))


def _warn(found: "Matches") -> None:
    for topic, why in found.skipped.items():
        click.echo(f"left out {topic}: {why}", err=True)
    for topic, why in found.doubts.items():
        click.echo(f"{topic}: {why}", err=True)


@contextmanager
def _progress(span: tuple[int, int], loop: int) -> Iterator[Tick]:
    """Show the progress as a bar on a terminal, and not at all on a pipe."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

    length = (span[1] - span[0]) / SECOND
    columns = (BarColumn(), TextColumn("{task.completed:.0f} of {task.total:.0f} s"), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), disable=not sys.stderr.isatty(), transient=True) as bar:
        task = bar.add_task("", total=length * loop)
        yield lambda turn, moment: bar.update(task, completed=turn * length + (moment - span[0]) / SECOND)


def _show(played: "Played", found: "Matches", seconds: float, as_json: bool) -> None:
    for topic, count in played.damaged.items():
        click.echo(f"{topic}: {count} damaged messages were left out", err=True)
    if as_json:
        session.show_json(
            {"seconds": round(seconds, 3), "messages": played.total, "sent": played.sent, "damaged": played.damaged,
             "left_out": found.skipped}
        )  # fmt: skip
        return
    click.echo(f"{'MESSAGES':>9}  TOPIC")
    for topic, count in played.sent.items():
        click.echo(f"{count:>9}  {topic}")
    click.echo(f"{played.total} messages in {seconds:.1f} s; `tms sensing` tells what became of them", err=True)
