"""Missions of deliveries between named places. No ROS outside of ``pick_objects.ros``."""

from pick_objects.approach import DriveToPlace
from pick_objects.arrival import ArrivalCheck, RecentScanFit, ResendGoal
from pick_objects.checkpoint import checkpoint_of, resume_errand
from pick_objects.config import ErrandSettings
from pick_objects.errand import Errand, MeasurePathLengths, PathLengthsMeasured
from pick_objects.goal_driver import GoalDriver, MoveBasePort
from pick_objects.job import DeliveryJob, DeliveryStage, ErrandState, ObjectLocation
from pick_objects.mission import Delivery, Mission, MissionError, MissionObject, errand_mission
from pick_objects.mission_file import load_mission, parse_mission
from pick_objects.search import LookForObject, LookTaken, SearchArea, search_area_of
from planar.driving import FinishTask, GoalFailed, GoalReached, RobotDisplaced

__all__ = [
    "ArrivalCheck",
    "Delivery",
    "DeliveryJob",
    "DeliveryStage",
    "DriveToPlace",
    "Errand",
    "ErrandSettings",
    "ErrandState",
    "FinishTask",
    "GoalDriver",
    "RobotDisplaced",
    "GoalReached",
    "GoalFailed",
    "LookForObject",
    "LookTaken",
    "MeasurePathLengths",
    "Mission",
    "MissionError",
    "MissionObject",
    "MoveBasePort",
    "ObjectLocation",
    "PathLengthsMeasured",
    "RecentScanFit",
    "ResendGoal",
    "SearchArea",
    "checkpoint_of",
    "errand_mission",
    "load_mission",
    "parse_mission",
    "resume_errand",
    "search_area_of",
]
