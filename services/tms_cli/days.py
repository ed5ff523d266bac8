"""Days as people name them on the command line, in the local time of this PC."""

from datetime import date, timedelta
from typing import Any

import click

from tms_cli.words import say
from tms_config.clock import utc_now


class Day(click.ParamType[date]):
    """A day: `2026-11-26`, `today` or `yesterday`."""

    name = "YYYY-MM-DD"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> date:
        """The day."""
        if isinstance(value, date):
            return value
        today = utc_now().astimezone().date()
        if value in ("today", "yesterday"):
            return today - timedelta(days=value == "yesterday")
        try:
            return date.fromisoformat(str(value))
        except ValueError:
            self.fail(say("'{value}' is no day like 2026-11-26, today or yesterday", value=value), param, ctx)
