"""Orders to the robot and events from it, in addition to those of planar.driving."""

from dataclasses import dataclass
from typing import Optional, Union

from pick_objects import DriveToPlace, GoalFailed, GoalReached, LookForObject, LookTaken, RobotDisplaced
from planar import Pose2


@dataclass(frozen=True)
class DockRobot:
    """Order: drive into the dock."""


@dataclass(frozen=True)
class UndockRobot:
    """Order: leave the dock."""


@dataclass(frozen=True)
class StopRobot:
    """Order: end what was ordered last."""


@dataclass(frozen=True)
class RobotDocked:
    """Event: the robot charges in the dock."""


@dataclass(frozen=True)
class RobotUndocked:
    """Event: the robot has left the dock."""


@dataclass(frozen=True)
class DockingFailed:
    """Event: docking or undocking has failed.

    Attributes:
        reason: Explanation for people.
    """

    reason: str


@dataclass(frozen=True)
class RobotInputs:
    """What is known of the robot.

    Attributes:
        pose: Estimated pose in the map.
        charge: Charge of the battery, 0 to 1; None if it is not known.
        is_docked: Whether it charges in the dock.
    """

    pose: Pose2
    charge: Optional[float] = None
    is_docked: bool = False


RobotOrder = Union[DriveToPlace, LookForObject, DockRobot, UndockRobot, StopRobot]
RobotEvent = Union[
    GoalReached, GoalFailed, RobotDisplaced, LookTaken, RobotDocked, RobotUndocked, DockingFailed
]
