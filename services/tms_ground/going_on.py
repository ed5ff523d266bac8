"""The start of `tms:ground`: with the ground, loads and work that were kept, as far as they can be read."""

from tms_ground.reasons import GroundAway, GroundDamaged, GroundGone, GroundOther, WorkLost
from tms_ground.watching import GroundWatch
from tms_runtime import durable
from tms_runtime.log import Logger


def go_on(watch: GroundWatch, log: Logger, now: float) -> dict[str, float]:
    """Go on where the process ended; `now` [s since 1970].

    Returns when machines were looked at last [s since 1970], without those of which nobody knows how they stood then.
    """
    missed = dict[str, float]()
    try:
        if watch.load():
            log.info("ground_goes_on", file=str(watch.file))
            _work_from_ground(watch, log, now, loads=True)
            missed = watch.replay()
            _tell_absence(watch, log, now)
        elif watch.file.exists():
            _work_from_ground(watch, log, now, loads=False)
            log.warning("ground_begins_anew", reason=GroundOther(str(durable.set_aside(watch.file))))
        elif watch.copy.exists():
            log.error("ground_begins_anew", reason=GroundGone())
            _work_from_copy(watch, log, now)
        else:  # the first start, or one after a crash before the first save
            missed = watch.replay()
            _tell_absence(watch, log, now)
    except (OSError, ValueError) as error:
        why = GroundDamaged(str(error), str(durable.set_aside(watch.file)))
        log.error("ground_begins_anew", reason=why)
        _work_from_copy(watch, log, now)
    watch.journal.begin()
    return missed


def _work_from_ground(watch: GroundWatch, log: Logger, now: float, loads: bool) -> None:
    try:
        watch.load_work(loads)
    except ValueError as error:
        _numbers_from_clock(watch, log, now, str(error))


def _work_from_copy(watch: GroundWatch, log: Logger, now: float) -> None:
    try:
        watch.load_copy()
    except (OSError, ValueError) as error:
        if watch.copy.exists():
            durable.set_aside(watch.copy)
        _numbers_from_clock(watch, log, now, str(error))


def _numbers_from_clock(watch: GroundWatch, log: Logger, now: float, problem: str) -> None:
    """Those of before may be in the database: a smaller number would replace one of them."""
    watch.work.number_from(int(now))
    watch.changed = True  # these numbers must be on the disk, too
    log.error("work_begins_anew", reason=WorkLost(problem))


def _tell_absence(watch: GroundWatch, log: Logger, now: float) -> None:
    if (seen := watch.work.seen) is not None:
        log.warning("ground_was_away", reason=GroundAway(max(0.0, now - seen)))
