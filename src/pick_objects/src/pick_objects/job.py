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


class DeliveryStage(enum.Enum):
    """How far a delivery has come; the values are those of home_service_msgs/DeliveryState."""

    WAITING = 0
    FETCHING = 1
    PICKING_UP = 2
    CARRYING = 3
    SETTING_DOWN = 4
    DELIVERED = 5
    FAILED = 6
    CANCELLED = 7


ENDED = (DeliveryStage.DELIVERED, DeliveryStage.FAILED, DeliveryStage.CANCELLED)
ON_ROBOT = (DeliveryStage.CARRYING, DeliveryStage.SETTING_DOWN)
"""Where the object of a delivery is then."""
STATE_OF_STAGE = {
    DeliveryStage.FETCHING: ErrandState.GOING_TO_PICKUP,
    DeliveryStage.PICKING_UP: ErrandState.PICKING_UP,
    DeliveryStage.CARRYING: ErrandState.GOING_TO_DROPOFF,
    DeliveryStage.SETTING_DOWN: ErrandState.SETTING_DOWN,
}
"""What the robot is about while a delivery is in progress."""


@dataclass
class DeliveryJob:
    """A delivery and what has become of it. ``attempts``: goals sent for it so far."""

    delivery: Delivery
    stage: DeliveryStage = DeliveryStage.WAITING
    attempts: int = 0
    reason: str = ""

    def fail(self, reason: str) -> None:
        self.stage, self.reason = DeliveryStage.FAILED, reason

    def cancel(self) -> None:
        self.stage, self.reason = DeliveryStage.CANCELLED, "cancelled"


@dataclass(frozen=True)
class ObjectLocation:
    """Where an object is: at a place, with the robot, or (neither) where the robot had to leave it.

    ``pose``: where it stands or stood last, in the map.
    """

    place: Optional[str]
    pose: Pose2
    is_carried: bool = False

    @property
    def dropped(self) -> "ObjectLocation":
        """Set down where the robot stands, if it was on it."""
        return ObjectLocation(None, self.pose) if self.is_carried else self
