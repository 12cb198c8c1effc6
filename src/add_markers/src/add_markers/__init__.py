"""The object of an errand as a marker: where it is shown, and when it is hidden."""

from add_markers.bodies import Bodies, Move, Solid, Vanish
from add_markers.config import MarkerSettings
from add_markers.parcel import CarriedParcel, TimedParcel

__all__ = ["Bodies", "CarriedParcel", "MarkerSettings", "Move", "Solid", "TimedParcel", "Vanish"]
