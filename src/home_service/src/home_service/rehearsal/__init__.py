"""Deprecated name of ``home_service.headless``."""

from planar.deprecation import deprecated_names

__getattr__ = deprecated_names(
    __name__,
    {
        "LOCALIZATION_CONFIG": "home_service.headless:LOCALIZATION_CONFIG",
        "NAVIGATION_CONFIG": "home_service.headless:NAVIGATION_CONFIG",
        "Conditions": "home_service.headless:EpisodeConditions",
        "Rehearsal": "home_service.headless:HeadlessMission",
        "Rehearsed": "home_service.headless:EpisodeResult",
        "parcel_of": "home_service.headless:parcel_for",
    },
)
