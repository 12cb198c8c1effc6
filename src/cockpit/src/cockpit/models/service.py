"""The state of a service (service/state) as HTML."""

import json
from datetime import datetime, timezone
from html import escape
from typing import Any, Dict, List, Mapping, Optional

from cockpit.errors import CockpitError
from cockpit.models.tables import paragraph, table

HEADS = ("Request", "Status", "Planned", "Due", "")
LOW, LOW_COLOUR, COLOUR = 0.2, "#c03030", "#2f9e44"
BAR = "display:inline-block;width:120px;height:10px;border:1px solid #888;border-radius:3px;overflow:hidden"


def service_html(text: str) -> str:
    """Format a message of service/state: battery, what the robot does, and the queue as it is planned.

    Args:
        text: JSON values.

    Raises:
        CockpitError: It is not a state of a service.
    """
    try:
        document = json.loads(text)
        state, tasks = document["state"], document["tasks"]
        more = int(state["open"]) - len(tasks)
        left = paragraph(f"{more} more") if more > 0 else ""
        return (
            _summary(state) + (table(HEADS, map(_row, tasks)) if tasks else paragraph("no requests")) + left
        )
    except (ValueError, LookupError, TypeError, AttributeError) as error:
        raise CockpitError(f"service/state: not a state of a service: {error!r:.100}") from error


def _summary(state: Mapping[str, Any]) -> str:
    carrying = f", carrying {escape(str(state['carrying']))}" if state["carrying"] else ""
    activity = f"<b>{escape(str(state['activity']))}</b>{carrying}"
    return f'<div style="margin:0 12px 6px 12px;font-size:12px">{_battery(state)}{activity}</div>'


def _battery(state: Mapping[str, Any]) -> str:
    if state["charge"] is None:
        return "no battery state<br>"
    charge = min(max(float(state["charge"]), 0.0), 1.0)
    colour = LOW_COLOUR if charge < LOW else COLOUR
    filled = (
        f'<span style="display:block;height:10px;width:{100.0 * charge:.0f}%;background:{colour}"></span>'
    )
    docked = ", in the dock" if state["is_docked"] else ""
    return f'<span style="{BAR}">{filled}</span> {100.0 * charge:.0f} %{docked}<br>'


def _row(task: Dict[str, Any]) -> List[str]:
    status = f"{task['status']}, late" if task.get("in_time") is False else str(task["status"])
    planned, due = (_clock(task.get(f"unix_millis_{name}")) for name in ("expected_finish_time", "deadline"))
    return [str(task["text"]), status, planned, due, str(task.get("reason") or "")]


def _clock(millis: Optional[float]) -> str:
    """Return a time of day; local, as those of request.sh."""
    if millis is None:
        return ""
    return datetime.fromtimestamp(millis / 1000.0, timezone.utc).astimezone().strftime("%H:%M")
