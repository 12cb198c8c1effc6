"""Inputs and outputs of docking."""

import enum
from dataclasses import dataclass
from typing import Optional, Protocol, Tuple

from planar import Pose2, Scan, Twist2
from planar.driving import DriveOutcome


class DockState(enum.Enum):
    """States of docking: those of kobuki_dock_drive, with STAGING and UNDOCKING."""

    IDLE = "IDLE"
    STAGING = "STAGING"
    """Navigation drives the robot to a pose before the dock."""
    SCAN = "SCAN"
    """The robot turns to find the dock's signals."""
    FIND_STREAM = "FIND_STREAM"
    """The robot turns towards the middle line of the dock."""
    GET_STREAM = "GET_STREAM"
    """The robot drives to the middle line."""
    ALIGNED = "ALIGNED"
    """The robot is on the middle line and turns to the dock."""
    ALIGNED_FAR = "ALIGNED_FAR"
    """The robot approaches along the middle line."""
    ALIGNED_NEAR = "ALIGNED_NEAR"
    """The same, slowly, within the near field."""
    BUMPED = "BUMPED"
    """The robot backs off from what it touched."""
    BUMPED_DOCK = "BUMPED_DOCK"
    """The robot charges and touches the dock."""
    DOCKED_IN = "DOCKED_IN"
    """The robot charges; docking ends when it has done so for a while."""
    DONE = "DONE"
    UNDOCKING = "UNDOCKING"
    """The robot leaves the dock backwards."""


class DockCode(enum.IntEnum):
    """How docking or undocking ended; numbers of Nav2's docking server, and CANCELLED."""

    NONE = 0
    """Success."""
    CANCELLED = 1
    DOCK_NOT_IN_DB = 901
    DOCK_NOT_VALID = 902
    FAILED_TO_STAGE = 903
    FAILED_TO_DETECT_DOCK = 904
    FAILED_TO_CONTROL = 905
    FAILED_TO_CHARGE = 906
    TIMEOUT = 907
    UNKNOWN = 999


@dataclass(frozen=True)
class DockInputs:
    """What is known at a control tick.

    Attributes:
        stamp: Time [s].
        base_in_odom: Robot pose by odometry.
        signals: Bytes of the right, centre and left receiver (kobuki_msgs/DockInfraRed), each with the pose
            of the robot in odom at which it was received; those since the last tick.
        bumpers: Pressed bumpers, bits of kobuki_msgs/SensorState.
        charger: Charger state of kobuki_msgs/SensorState; 0 is discharging.
        scan: Latest scan; None for none.
        odom_in_map: Pose of the odometry frame in the map; None while unknown.
    """

    stamp: float
    base_in_odom: Pose2
    signals: Tuple[Tuple[Pose2, Tuple[int, int, int]], ...] = ()
    bumpers: int = 0
    charger: int = 0
    scan: Optional[Scan] = None
    odom_in_map: Optional[Pose2] = None


@dataclass(frozen=True)
class DockResult:
    """How docking or undocking ended.

    Attributes:
        code: Reason.
        text: The text of the action's result.
    """

    code: DockCode
    text: str

    @property
    def is_success(self) -> bool:
        """Whether the robot has docked, or undocked."""
        return self.code is DockCode.NONE


@dataclass(frozen=True)
class DockDecision:
    """Outcome of a control tick.

    Attributes:
        command: Velocity to send; None while navigation drives, or while nothing is to be done.
        state: State after the tick.
        text: Explanation for people.
        result: How the task ended, at the tick at which it ends.
    """

    command: Optional[Twist2]
    state: DockState
    text: str = ""
    result: Optional[DockResult] = None


class StagingPort(Protocol):
    """Client of move_base that drives the robot to the staging pose (see pick_objects.MoveBasePort)."""

    def send(self, goal: Pose2) -> None:
        """Send a goal in the map frame, which replaces any earlier one."""

    def outcome(self) -> Optional[DriveOutcome]:
        """Return the outcome of the last goal once; None while it is active and afterwards."""

    def cancel(self) -> None:
        """Cancel the goal if it is active."""
