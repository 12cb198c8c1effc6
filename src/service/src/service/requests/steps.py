"""Steps of a task: what the robot does one after the other, and what is journaled when each is done."""

from dataclasses import dataclass
from typing import Union


@dataclass(frozen=True)
class Drive:
    """Drive to a named place."""

    place: str


@dataclass(frozen=True)
class FindObject:
    """Find out where an object is."""

    object_name: str


@dataclass(frozen=True)
class DriveToObject:
    """Drive to where an object is known to be; one of which that is not known is searched."""

    object_name: str


@dataclass(frozen=True)
class PickUp:
    """Take an object on board."""

    object_name: str


@dataclass(frozen=True)
class SetDown:
    """Set an object down at the place where the robot stands."""

    object_name: str
    place: str


@dataclass(frozen=True)
class Pause:
    """Stand for a time [s]."""

    seconds: float


@dataclass(frozen=True)
class EnterDock:
    """Drive into the dock."""


Step = Union[Drive, FindObject, DriveToObject, PickUp, SetDown, Pause, EnterDock]
DRIVES = (Drive, DriveToObject)
