"""Deprecated name of the package ``headless_mission``."""

from planar.deprecation import deprecated_names

__getattr__ = deprecated_names(
    __name__,
    {
        "LOCALIZATION_CONFIG": "headless_mission:LOCALIZATION_CONFIG",
        "NAVIGATION_CONFIG": "headless_mission:NAVIGATION_CONFIG",
        "Conditions": "headless_mission:EpisodeConditions",
        "Rehearsal": "headless_mission:HeadlessMission",
        "Rehearsed": "headless_mission:EpisodeResult",
        "parcel_of": "headless_mission:parcel_for",
    },
)
