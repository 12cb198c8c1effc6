"""The object of an errand as a marker: where it is shown, and when it is hidden."""

from add_markers.boxes import BoxPlacer, PlaceBox, RemoveBox, SolidBox
from add_markers.config import MarkerSettings
from add_markers.parcel import CarriedParcel, TimedParcel

__all__ = [
    "BoxPlacer",
    "CarriedParcel",
    "MarkerSettings",
    "PlaceBox",
    "RemoveBox",
    "SolidBox",
    "TimedParcel",
]
