"""Events of a run: what is judged, recorded and reported, from ROS or from a headless mission.

Times are simulated seconds. The stamp of an event is that of its measurement; what has none bears the time at
which it was received.
"""

from dataclasses import dataclass
from typing import Callable, NamedTuple, Optional, Tuple

import numpy as np

from pick_objects import Delivery, DeliveryStage
from planar import OccupancyGrid, Pose2, Twist2

# Actions of a marker, by the numbers of visualization_msgs/Marker.
SHOW, DELETE, DELETE_ALL = 0, 2, 3
# Status of a goal that was reached, by the numbers of actionlib_msgs/GoalStatus.
SUCCEEDED = 3


class Publication(NamedTuple):
    """The message that an event was read from, for the trace, which must be equal to the last bit.

    Attributes:
        stamp: Stamp of its header [ns].
        topic: Resolved topic.
        node: Publishing node.
        rotation: z and w of the quaternion, if the message is a pose.
    """

    stamp: int
    topic: str
    node: str
    rotation: Tuple[float, float] = (0.0, 1.0)


@dataclass(frozen=True)
class RunEvent:
    """Something that happened in a run.

    Attributes:
        stamp: Simulated time [s].
    """

    stamp: float


@dataclass(frozen=True)
class ClockAdvanced(RunEvent):
    """Simulated time was published."""


@dataclass(frozen=True)
class NodesAwaited(RunEvent):
    """The simulator waits for these nodes."""

    names: Tuple[str, ...]


@dataclass(frozen=True)
class RemarksUpdated(RunEvent):
    """Why the run may not be repeatable, as far as known."""

    lines: Tuple[str, ...]


@dataclass(frozen=True)
class TruthUpdated(RunEvent):
    """True state of the judged robot.

    Attributes:
        pose: Pose of the base in the world.
        twist: Velocity of the base.
        publication: Message of the event, if any.
    """

    pose: Pose2
    twist: Twist2 = Twist2()
    publication: Optional[Publication] = None


@dataclass(frozen=True)
class OtherRobotUpdated(RunEvent):
    """An event of another robot than the judged one.

    Attributes:
        robot: Its namespace.
        event: The event.
    """

    robot: str
    event: RunEvent


@dataclass(frozen=True)
class OdometryUpdated(RunEvent):
    """Pose of the base in the odometry frame."""

    base_in_odom: Pose2


@dataclass(frozen=True)
class CorrectionUpdated(RunEvent):
    """Pose of the odometry frame in the map, by localization or mapping."""

    odom_in_map: Pose2


@dataclass(frozen=True)
class EstimateUpdated(RunEvent):
    """Estimated pose of the base in the map; ``publication`` as in ``TruthUpdated``."""

    pose: Pose2
    publication: Optional[Publication] = None


@dataclass(frozen=True)
class BodiesTouched(RunEvent):
    """The robot touched bodies of these names."""

    names: Tuple[str, ...]


@dataclass(frozen=True)
class GoalRequested(RunEvent):
    """A goal was sent to navigation.

    Attributes:
        identity: Id of the goal; empty if navigation generates it later, as for a click in rviz.
        frame: Frame of the pose.
        pose: Goal pose.
    """

    identity: str
    frame: str
    pose: Pose2


@dataclass(frozen=True)
class GoalAccepted(RunEvent):
    """Navigation drives to a goal in the map; ``publication`` as in ``TruthUpdated``."""

    pose: Pose2
    publication: Optional[Publication] = None


@dataclass(frozen=True)
class GoalStatusUpdated(RunEvent):
    """Status of a goal, by the numbers of actionlib."""

    identity: str
    status: int
    text: str


@dataclass(frozen=True)
class GoalEnded(GoalStatusUpdated):
    """A goal has ended; ``publication`` as in ``TruthUpdated``."""

    publication: Optional[Publication] = None


@dataclass(frozen=True, eq=False)
class PlanUpdated(RunEvent):
    """A plan to the goal was made: points (N, 2) in the map [m]."""

    points_xy: np.ndarray


@dataclass(frozen=True)
class MissionRequested(RunEvent):
    """A mission was sent to the robot, as YAML; empty: the mission of its parameters."""

    text: str


@dataclass(frozen=True)
class DeliveryProgress:
    """Published state of a delivery.

    Attributes:
        delivery: The delivery.
        stage: Its stage.
        attempts: Goals sent for it so far.
        reason: Why it failed.
        object_at: Where the robot reports its object to be in the map [m]; None if it does not know.
    """

    delivery: Delivery
    stage: DeliveryStage
    attempts: int
    reason: str
    object_at: Optional[Tuple[float, float]] = None


@dataclass(frozen=True)
class MissionUpdated(RunEvent):
    """The mission has changed.

    Attributes:
        state: Current activity.
        deliveries: All deliveries.
        reason: How the mission ended.
        place: Place where the robot is or to which it is driving.
        attempt: Number of the attempt to reach it.
        publication: Message of the event, if any.
    """

    state: str
    deliveries: Tuple[DeliveryProgress, ...]
    reason: str = ""
    place: str = ""
    attempt: int = 0
    publication: Optional[Publication] = None


@dataclass(frozen=True)
class StateUpdated(RunEvent):
    """Current activity of the mission, in words."""

    text: str


@dataclass(frozen=True)
class ServiceUpdated(RunEvent):
    """State of the service.

    Attributes:
        charge: Charge of the battery, 0 to 1; None if it is not known.
    """

    charge: Optional[float]


@dataclass(frozen=True)
class MarkerUpdated(RunEvent):
    """A marker was published.

    Attributes:
        name: Namespace of the marker: the object that it shows.
        number: Its id in the namespace.
        position: x, y and z in its frame [m].
        action: SHOW, DELETE, DELETE_ALL, or another number of visualization_msgs/Marker.
        is_carried: It moves with the robot.
        is_visible: Its size and colour can be seen.
    """

    name: str
    number: int
    position: Tuple[float, float, float]
    action: int = SHOW
    is_carried: bool = False
    is_visible: bool = True


@dataclass(frozen=True, eq=False)
class MapPublished(RunEvent):
    """A map was published; ``read`` converts it, which may raise PlanarError."""

    read: Callable[[], OccupancyGrid]


@dataclass(frozen=True)
class LineLogged(RunEvent):
    """A node logged a line.

    Attributes:
        node: Name of the node, without a slash.
        text: The line.
        is_warning: It is a warning or an error.
    """

    node: str
    text: str
    is_warning: bool = False


@dataclass(frozen=True)
class SensorDistrusted(RunEvent):
    """Navigation found a sensor implausible, for this reason."""

    reason: str


@dataclass(frozen=True)
class ExplorationUpdated(RunEvent):
    """State of an exploration: activity, known free space [m^2], and frontiers that are left."""

    state: str
    area: float
    frontiers: int


@dataclass(frozen=True)
class ExplorationEnded(RunEvent):
    """An exploration has ended; ``status`` by the numbers of actionlib."""

    status: int
    text: str
    publication: Optional[Publication] = None


@dataclass(frozen=True)
class PlaybackUpdated(RunEvent):
    """State of the playback of a recording, in words."""

    text: str
