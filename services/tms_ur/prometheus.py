"""Alerts that only Prometheus can judge: asked of it where the site names it (`console: {prometheus: ADDRESS}`)."""

from collections.abc import Mapping
from datetime import datetime
from http.client import HTTPException
from typing import Literal
from urllib.parse import urljoin
from urllib.request import urlopen

from pydantic import BaseModel, Field

from tms_ur.alarm_models import Alarm, Severity
from tms_ur.alarms import NOT_SEEN_HERE
from tms_ur.reason_view import ReasonView, Texts, view
from tms_ur.reasons import PrometheusAway

PATH = "/api/v1/alerts"
LIMIT = 3.0  # s for an answer
MOST = 1_000_000  # bytes of one
SUBJECTS = ("machine", "process", "service", "instance")  # labels, what an alert is about: the first one it has
AWAY = "PrometheusAway"


class Annotations(BaseModel):
    """What rules.yml says of an alert."""

    summary: str
    summary_ja: str = ""


class Alert(BaseModel):
    """One alert, as Prometheus tells it."""

    labels: Mapping[str, str]
    annotations: Annotations
    state: str
    since: datetime = Field(alias="activeAt")


class Alerts(BaseModel):
    """All of them."""

    alerts: tuple[Alert, ...]


class Answer(BaseModel):
    """Of Prometheus."""

    status: Literal["success"]
    data: Alerts


def alarms(address: str, now: datetime) -> list[Alarm]:
    """What fires at a Prometheus and is not judged here; one alarm of its own where it cannot be asked."""
    try:
        with urlopen(urljoin(address, PATH), timeout=LIMIT) as answer:
            told = Answer.model_validate_json(answer.read(MOST))
    except (OSError, HTTPException, ValueError) as error:
        reason = view(PrometheusAway(address, str(error)))
        return [Alarm(name=AWAY, severity="warning", subject=address, reason=reason, since=now)]
    return [_alarm(one) for one in told.data.alerts if one.state == "firing" and _name(one) in NOT_SEEN_HERE]


def _name(alert: Alert) -> str:
    return alert.labels.get("alertname", "")


def _alarm(alert: Alert) -> Alarm:
    told = alert.annotations
    texts = Texts(en=told.summary, ja=told.summary_ja or told.summary)
    severity: Severity = "critical" if alert.labels.get("severity") == "critical" else "warning"
    subject = next((alert.labels[name] for name in SUBJECTS if name in alert.labels), "")
    none = Texts(en="", ja="")
    reason = ReasonView(code=_name(alert), args=dict(alert.labels), text=texts, details=none, action=None)
    return Alarm(name=_name(alert), severity=severity, subject=subject, reason=reason, since=alert.since)
