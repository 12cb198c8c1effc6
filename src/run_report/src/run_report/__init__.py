"""Report of a run: HTML page, picture, animation and trajectories. No ROS."""

from run_report.figures import summary
from run_report.record import (
    CollisionEvent,
    GoalEvent,
    LoggedWarning,
    MarkerEvent,
    RecordError,
    RunRecord,
    StateEvent,
    ZoneRecord,
    load_record,
)
from run_report.writing import write_report

__all__ = [
    "CollisionEvent",
    "GoalEvent",
    "LoggedWarning",
    "MarkerEvent",
    "RecordError",
    "RunRecord",
    "StateEvent",
    "ZoneRecord",
    "load_record",
    "summary",
    "write_report",
]
