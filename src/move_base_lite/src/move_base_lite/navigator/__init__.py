"""The Navigator: move_base's state machine, and what it remembers and decides."""

from move_base_lite.navigator.decision import Decision, Outcome, Progress, Status, Trigger
from move_base_lite.navigator.navigator import Navigator
from move_base_lite.navigator.zones import Zone, Zones, load_zones

__all__ = [
    "Decision",
    "Navigator",
    "Outcome",
    "Progress",
    "Status",
    "Trigger",
    "Zone",
    "Zones",
    "load_zones",
]
