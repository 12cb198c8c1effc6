"""Inputs of the Navigator at a control tick."""

import functools
import warnings
from dataclasses import dataclass
from typing import Any, Callable, Optional, Sequence, Tuple

from move_base_lite.costmap import Observation, observation_from_scan
from planar import Pose2, Scan, Twist2


@dataclass(frozen=True)
class RobotState:
    """State of the robot at a control tick.

    Attributes:
        stamp: Time of the tick [s].
        base_in_map: Pose in the map, from localization.
        base_in_odom: Pose in the odometry frame.
        twist: Velocity from odometry.
    """

    stamp: float
    base_in_map: Pose2
    base_in_odom: Pose2
    twist: Twist2

    def distance_to(self, other: "RobotState") -> float:
        """Compute the distance on which localization and odometry agree [m].

        It is the smaller of both: neither a jump of localization nor spinning wheels count as motion.
        """
        return min(
            self.base_in_map.distance_to(other.base_in_map), self.base_in_odom.distance_to(other.base_in_odom)
        )


@dataclass(frozen=True)
class NavigatorInputs:
    """What the Navigator is given beside the state of the robot.

    Attributes:
        observations: Sensor data since the last tick, transformed to the present pose.
        latency: Time until the command of this tick takes effect [s].
    """

    observations: Sequence[Observation] = ()
    latency: float = 0.0


def accepts_separate_values(tick: Callable[..., Any]) -> Callable[..., Any]:
    """Decorate ``Navigator.tick`` so that it also accepts the arguments of earlier versions."""

    @functools.wraps(tick)
    def call(self: Any, *arguments: Any, **named: Any) -> Any:
        if arguments and isinstance(arguments[0], RobotState) or "state" in named:
            return tick(self, *arguments, **named)
        text = "Navigator.tick(now, base_in_map, ...) is deprecated; use tick(RobotState, NavigatorInputs)"
        warnings.warn(text, DeprecationWarning, stacklevel=2)
        return tick(self, *_from_separate_values(self.settings.scan_topic, *arguments, **named))

    return call


def _from_separate_values(
    scan_topic: str,
    now: float,
    base_in_map: Pose2,
    base_in_odom: Pose2,
    twist: Twist2,
    scan: Optional[Scan],
    observations: Sequence[Observation] = (),
    latency: float = 0.0,
) -> Tuple[RobotState, NavigatorInputs]:
    if scan is not None:
        observations = [*observations, observation_from_scan(scan_topic, scan)]
    return RobotState(now, base_in_map, base_in_odom, twist), NavigatorInputs(observations, latency)
