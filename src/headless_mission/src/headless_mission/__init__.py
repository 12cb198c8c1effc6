"""Headless simulation: a whole mission in one process, without ROS."""

from evaluation.presets import LOCALIZATION_CONFIG, NAVIGATION_CONFIG
from headless_mission.conditions import EpisodeConditions
from headless_mission.mission import HeadlessMission, parcel_for
from headless_mission.result import EpisodeResult

__all__ = [
    "EpisodeConditions",
    "EpisodeResult",
    "HeadlessMission",
    "LOCALIZATION_CONFIG",
    "NAVIGATION_CONFIG",
    "parcel_for",
]
