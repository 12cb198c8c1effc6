"""Markers for the objects of an errand or a mission, and boxes for solid ones. No ROS outside of ``ros``."""

from add_markers.boxes import BoxPlacer, PlaceBox, RemoveBox, SolidBox
from add_markers.config import MarkerSettings
from add_markers.mission_boxes import BoxSimulator, MissionBoxes
from add_markers.parcel import CarriedParcel, TimedParcel

__all__ = [
    "BoxPlacer",
    "BoxSimulator",
    "CarriedParcel",
    "MarkerSettings",
    "MissionBoxes",
    "PlaceBox",
    "RemoveBox",
    "SolidBox",
    "TimedParcel",
]
