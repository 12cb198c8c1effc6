"""The state of a mission as HTML."""

from html import escape
from typing import Any

from cockpit.models.tables import table

# The states of a home_service_msgs/DeliveryState by number.
STATES = ("waiting", "fetching", "picking up", "carrying", "setting down", "delivered", "failed", "cancelled")
FIRST_END = STATES.index("delivered")
HEADS = ("Object", "From", "To", "State")


def mission_html(mission: Any) -> str:
    """Format a home_service_msgs/MissionState."""
    name = f"{escape(mission.mission)}: " if mission.mission else ""
    summary = f"<b>{name}{escape(mission.state)}</b>, {100.0 * mission.progress:.0f} %"
    if mission.time_left > 0.0:
        summary += f", {mission.time_left:.0f} s left"
    if mission.reason:
        summary += f" ({escape(mission.reason)})"
    return f'<div style="margin:0 12px 6px 12px;font-size:12px">{summary}</div>' + table(
        HEADS, map(_row, mission.deliveries)
    )


def is_running(mission: Any) -> bool:
    """Return whether a delivery of a home_service_msgs/MissionState is pending."""
    return any(each.state < FIRST_END for each in mission.deliveries)


def _row(each: Any):
    what = each.delivery
    state = STATES[each.state] if each.state < len(STATES) else str(each.state)
    return what.object or what.name, what.source, what.destination, f"{state} {each.reason}".strip()
