"""Deprecated name of the package ``headless_mission``."""

from planar.deprecation import deprecated_names

__getattr__ = deprecated_names(
    __name__,
    {
        "EpisodeConditions": "headless_mission:EpisodeConditions",
        "EpisodeResult": "headless_mission:EpisodeResult",
        "HeadlessMission": "headless_mission:HeadlessMission",
        "LOCALIZATION_CONFIG": "headless_mission:LOCALIZATION_CONFIG",
        "NAVIGATION_CONFIG": "headless_mission:NAVIGATION_CONFIG",
        "parcel_for": "headless_mission:parcel_for",
    },
)
