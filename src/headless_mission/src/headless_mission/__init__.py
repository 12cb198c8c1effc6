"""Headless simulation: a whole mission in one process, without ROS."""

from evaluation.presets import LOCALIZATION_CONFIG, NAVIGATION_CONFIG
from headless_mission.mission import (
    EpisodeConditions,
    EpisodeResult,
    HeadlessMission,
    parcel_for,
)

__all__ = [
    "EpisodeConditions",
    "EpisodeResult",
    "HeadlessMission",
    "LOCALIZATION_CONFIG",
    "NAVIGATION_CONFIG",
    "parcel_for",
]
