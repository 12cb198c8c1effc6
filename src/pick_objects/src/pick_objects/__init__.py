"""Missions of deliveries between named places; pure but for node.py and nodes."""

from pick_objects.approach import GoTo
from pick_objects.arrival import Arrival, Fit, SendAgain
from pick_objects.config import ErrandSettings
from pick_objects.errand import Errand, MeasureWays, WaysMeasured
from pick_objects.job import ErrandState, Job, Stage, Whereabouts
from pick_objects.mission import Delivery, Mission, MissionError, Thing, errand_mission
from pick_objects.mission_file import load_mission, parse_mission
from pick_objects.record import record_of, resumed
from planar.driving import FinishTask, GoalFailed, GoalReached, RobotDisplaced

__all__ = [
    "Arrival",
    "Delivery",
    "Errand",
    "ErrandSettings",
    "ErrandState",
    "FinishTask",
    "Fit",
    "GoTo",
    "RobotDisplaced",
    "GoalReached",
    "GoalFailed",
    "Job",
    "MeasureWays",
    "Mission",
    "MissionError",
    "SendAgain",
    "Stage",
    "Thing",
    "WaysMeasured",
    "Whereabouts",
    "errand_mission",
    "load_mission",
    "parse_mission",
    "record_of",
    "resumed",
]
