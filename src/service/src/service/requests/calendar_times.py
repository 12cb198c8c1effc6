"""Times as people write them, and repetitions; local time unless a zone is given."""

import re
from datetime import datetime, timedelta, tzinfo
from typing import Optional

from service.errors import RequestError

MINUTE, HOUR, DAY = 60.0, 3600.0, 86400.0
UNITS = {"s": 1.0, "sec": 1.0, "min": MINUTE, "m": MINUTE, "h": HOUR, "d": DAY}
DURATION = re.compile(r"\+?\s*(\d+(?:\.\d+)?)\s*(s|sec|min|m|h|d)", re.IGNORECASE)
CLOCK = re.compile(r"(\d{1,2}):(\d{2})(?::(\d{2}))?")
FORMS = "18:00, +30min or 2026-11-30T18:00"


def parse_time(text: str, now: float, zone: Optional[tzinfo] = None) -> float:
    """Convert a time to Unix seconds.

    Args:
        text: ``18:00`` (the next one), ``+30min`` (from now), or ISO 8601.
        now: Unix time [s].
        zone: Time zone; None for that of the machine.

    Raises:
        RequestError: If the text has no such form.
    """
    text = text.strip()
    if text.startswith("+"):
        return now + parse_duration(text)
    today = datetime.fromtimestamp(now, zone)
    match = CLOCK.fullmatch(text)
    try:
        if match:
            hours, minutes, seconds = (int(number or 0) for number in match.groups())
            at = today.replace(hour=hours, minute=minutes, second=seconds, microsecond=0)
            return (at if at.timestamp() >= now else at + timedelta(days=1)).timestamp()
        moment = datetime.fromisoformat(text.replace("Z", "+00:00"))
        return (moment if moment.tzinfo is not None else moment.replace(tzinfo=zone)).timestamp()
    except (ValueError, OverflowError, OSError):
        raise RequestError([f"'{text}' is no time; expected {FORMS}"]) from None


def parse_duration(text: str) -> float:
    """Convert ``90``, ``90 s``, ``5min``, ``2 h`` to seconds.

    Raises:
        RequestError: If the text has no such form.
    """
    match = DURATION.fullmatch(text.strip()) or DURATION.fullmatch(text.strip() + "s")
    if match is None:
        raise RequestError([f"'{text}' is no duration; expected 90s, 5min, 2h or 1d"])
    return float(match[1]) * UNITS[match[2].lower()]


def next_repetition(expression: str, after: float, zone: Optional[tzinfo] = None) -> float:
    """Return the Unix time of the first repetition after a time [s].

    Args:
        expression: Cron expression with five fields: minute, hour, day, month, weekday.
        after: Unix time [s].
        zone: Time zone; None for that of the machine.

    Raises:
        RequestError: If the expression is not valid or never due.
    """
    from croniter import CroniterError, croniter  # late: only services with repetitions need it

    if len(expression.split()) != 5:
        raise RequestError([f"repeat: '{expression}' is not valid; expected five fields, as '0 8 * * 1-5'"])
    try:
        start = datetime.fromtimestamp(after, zone).replace(microsecond=0)
        return float(croniter(expression, start).get_next(datetime).timestamp())
    except (CroniterError, ValueError, OverflowError) as error:
        raise RequestError([f"repeat: '{expression}' is not valid ({error})"]) from None


def clock_text(unix: float, zone: Optional[tzinfo] = None) -> str:
    """Return a time for people: ``2026-11-30 18:00:00``."""
    return datetime.fromtimestamp(unix, zone).strftime("%Y-%m-%d %H:%M:%S")
