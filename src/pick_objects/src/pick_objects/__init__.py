"""Missions of deliveries between named places. No ROS outside of ``pick_objects.ros``."""

from typing import TYPE_CHECKING

from planar.lazy_names import lazy_names

if TYPE_CHECKING:
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

__getattr__ = lazy_names(
    __name__,
    {
        "pick_objects.approach": ("DriveToPlace",),
        "pick_objects.arrival": ("ArrivalCheck", "RecentScanFit", "ResendGoal"),
        "pick_objects.checkpoint": ("checkpoint_of", "resume_errand"),
        "pick_objects.config": ("ErrandSettings",),
        "pick_objects.errand": ("Errand", "MeasurePathLengths", "PathLengthsMeasured"),
        "pick_objects.goal_driver": ("GoalDriver", "MoveBasePort"),
        "pick_objects.job": ("DeliveryJob", "DeliveryStage", "ErrandState", "ObjectLocation"),
        "pick_objects.mission": ("Delivery", "Mission", "MissionError", "MissionObject", "errand_mission"),
        "pick_objects.mission_file": ("load_mission", "parse_mission"),
        "pick_objects.search": ("LookForObject", "LookTaken", "SearchArea", "search_area_of"),
        "planar.driving": ("FinishTask", "GoalFailed", "GoalReached", "RobotDisplaced"),
    },
)
