"""State of a mission and of its deliveries."""

import enum
from dataclasses import dataclass
from typing import Optional

from pick_objects.mission import Delivery
from planar import Pose2


class ErrandState(enum.Enum):
    """Current activity of the robot; the values are published on ``~state``."""

    READY = "ready"
    ORDERING = "choosing the order"
    SEARCHING = "searching"
    GOING_TO_PICKUP = "going to pickup"
    PICKING_UP = "picking up"
    GOING_TO_DROPOFF = "going to dropoff"
    SETTING_DOWN = "setting down"
    DELIVERED = "delivered"
    FAILED = "failed"
    CANCELLED = "cancelled"


class DeliveryStage(enum.Enum):
    """Stage of a delivery; the values are those of home_service_msgs/DeliveryState."""

    WAITING = 0
    FETCHING = 1
    PICKING_UP = 2
    CARRYING = 3
    SETTING_DOWN = 4
    DELIVERED = 5
    FAILED = 6
    CANCELLED = 7


ENDED = (DeliveryStage.DELIVERED, DeliveryStage.FAILED, DeliveryStage.CANCELLED)
# Stages in which the object is on the robot.
ON_ROBOT = (DeliveryStage.CARRYING, DeliveryStage.SETTING_DOWN)
# State of the errand while a delivery is in progress.
STATE_OF_STAGE = {
    DeliveryStage.FETCHING: ErrandState.GOING_TO_PICKUP,
    DeliveryStage.PICKING_UP: ErrandState.PICKING_UP,
    DeliveryStage.CARRYING: ErrandState.GOING_TO_DROPOFF,
    DeliveryStage.SETTING_DOWN: ErrandState.SETTING_DOWN,
}


@dataclass
class DeliveryJob:
    """A delivery and its state.

    Attributes:
        delivery: What to carry where.
        stage: How far it has come.
        attempts: Goals sent for it so far.
        reason: Why it failed or was cancelled; where an object that was only to be found is.
    """

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
    """Location of an object: at a place, on the robot, or, if neither, where the robot had to leave it.

    Attributes:
        place: Name of the place; None: not at a place.
        pose: Pose in the map where it stands or stood last.
        is_carried: It is on the robot.
    """

    place: Optional[str]
    pose: Pose2
    is_carried: bool = False

    @property
    def dropped(self) -> "ObjectLocation":
        """The location after the robot has set the object down where it stands."""
        return ObjectLocation(None, self.pose) if self.is_carried else self
