"""For how long each rule has held: an alarm is told when that is as long as the rule asks, as Prometheus does."""

from dataclasses import dataclass

from tms_reason.reason import Reason
from tms_ur.alarm_models import Alarm
from tms_ur.alarms import RULES, Facts, Rule
from tms_ur.reason_view import view


@dataclass(frozen=True)
class Pending:
    """A rule holds for something since then; the alarm is made once, as each has texts in two languages."""

    rule: Rule
    reason: Reason
    began: float  # s
    alarm: Alarm


class AlarmKeeper:
    """Used under the lock of the board. After a start of tms:ur every duration begins anew."""

    def __init__(self) -> None:
        self._pending: dict[tuple[str, str], Pending] = {}

    def judge(self, facts: Facts) -> list[Alarm]:
        """What is to be told now, in the order of the rules."""
        found = [(rule, *finding) for rule in RULES for finding in rule.find(facts, *rule.numbers)]
        self._pending = {(rule.name, on): self._since(rule, on, why, facts) for rule, on, why in found}
        return [one.alarm for one in self._pending.values() if facts.now - one.began >= one.rule.lasts]

    def _since(self, rule: Rule, subject: str, why: Reason, facts: Facts) -> Pending:
        before = self._pending.get((rule.name, subject))
        if before is not None and before.reason == why:
            return before
        began, since = (before.began, before.alarm.since) if before else (facts.now, facts.state.time)
        alarm = Alarm(name=rule.name, severity=rule.severity, subject=subject, reason=view(why), since=since)
        return Pending(rule, why, began, alarm)
