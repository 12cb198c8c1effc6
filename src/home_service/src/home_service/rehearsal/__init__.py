"""The whole mission in one process, without ROS."""

from home_service.rehearsal.rehearsal import (
    LOCALIZATION_CONFIG,
    NAVIGATION_CONFIG,
    Conditions,
    Rehearsal,
    Rehearsed,
    parcel_of,
)

__all__ = ["LOCALIZATION_CONFIG", "NAVIGATION_CONFIG", "Conditions", "Rehearsal", "Rehearsed", "parcel_of"]
