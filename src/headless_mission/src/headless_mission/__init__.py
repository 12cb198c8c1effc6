"""Headless simulation: a whole mission in one process, without ROS."""

from typing import TYPE_CHECKING

from planar.lazy_names import lazy_names

if TYPE_CHECKING:
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

__getattr__ = lazy_names(
    __name__,
    {
        "evaluation.presets": ("LOCALIZATION_CONFIG", "NAVIGATION_CONFIG"),
        "headless_mission.conditions": ("EpisodeConditions",),
        "headless_mission.mission": ("HeadlessMission", "parcel_for"),
        "headless_mission.result": ("EpisodeResult",),
    },
)
