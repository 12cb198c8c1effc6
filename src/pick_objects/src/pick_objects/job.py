"""How a mission and its deliveries stand."""

import enum
from dataclasses import dataclass
from typing import Optional

from pick_objects.mission import Delivery
from planar import Pose2


class ErrandState(enum.Enum):
    """What the robot is about; the values are what ``~state`` publishes."""

    READY = "ready"
    ORDERING = "choosing the order"
    GOING_TO_PICKUP = "going to pickup"
    PICKING_UP = "picking up"
    GOING_TO_DROPOFF = "going to dropoff"
    SETTING_DOWN = "setting down"
    DELIVERED = "delivered"
    FAILED = "failed"
    CANCELLED = "cancelled"


class Stage(enum.Enum):
    """How far a delivery has come; the values are those of home_service_msgs/DeliveryState."""

    WAITING = 0
    FETCHING = 1
    PICKING_UP = 2
    CARRYING = 3
    SETTING_DOWN = 4
    DELIVERED = 5
    FAILED = 6
    CANCELLED = 7


ENDED = (Stage.DELIVERED, Stage.FAILED, Stage.CANCELLED)
ON_ROBOT = (Stage.CARRYING, Stage.SETTING_DOWN)
"""Where the object of a delivery is then."""
STATE_OF_STAGE = {
    Stage.FETCHING: ErrandState.GOING_TO_PICKUP,
    Stage.PICKING_UP: ErrandState.PICKING_UP,
    Stage.CARRYING: ErrandState.GOING_TO_DROPOFF,
    Stage.SETTING_DOWN: ErrandState.SETTING_DOWN,
}
"""What the robot is about while a delivery is in progress."""


@dataclass
class Job:
    """A delivery and what has become of it. ``attempts``: goals sent for it so far."""

    delivery: Delivery
    stage: Stage = Stage.WAITING
    attempts: int = 0
    reason: str = ""

    def fail(self, reason: str) -> None:
        self.stage, self.reason = Stage.FAILED, reason

    def cancel(self) -> None:
        self.stage, self.reason = Stage.CANCELLED, "cancelled"


@dataclass(frozen=True)
class Whereabouts:
    """Where an object is: at a place, with the robot, or (neither) where the robot had to leave it.

    ``pose``: where it stands or stood last, in the map.
    """

    place: Optional[str]
    pose: Pose2
    is_carried: bool = False

    @property
    def left(self) -> "Whereabouts":
        """Set down where the robot stands, if it was on it."""
        return Whereabouts(None, self.pose) if self.is_carried else self
