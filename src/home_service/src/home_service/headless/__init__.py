"""Headless simulation: a whole mission in one process, without ROS."""

from home_service.headless.mission import (
    LOCALIZATION_CONFIG,
    NAVIGATION_CONFIG,
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
