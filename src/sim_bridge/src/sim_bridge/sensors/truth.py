"""Ground truth of a robot, as sensors without errors."""

import math
from dataclasses import dataclass
from typing import Tuple

from planar import Pose2, Twist2
from sim_bridge.config import SimulationSettings
from sim_bridge.sensors.base import Schedule, SensorContext, every


@dataclass(frozen=True)
class TruthReading:
    """True state of a robot.

    Attributes:
        base_in_world: Pose of the base.
        twist: Velocity in the base frame.
        tilt: Angle between the robot's z axis and the vertical [rad].
    """

    base_in_world: Pose2
    twist: Twist2
    tilt: float


@dataclass(frozen=True)
class WheelState:
    """State of the driven wheels, those on the left first.

    Attributes:
        angles: Angles [rad].
        speeds: Speeds [rad/s].
    """

    angles: Tuple[float, ...]
    speeds: Tuple[float, ...]


class GroundTruth:
    """Measures pose, twist and tilt of the robot."""

    name, frame, on_demand = "ground_truth", "world", False

    def schedule(self, settings: SimulationSettings) -> Schedule:
        return every(None, settings)

    def measure(self, context: SensorContext) -> TruthReading:
        base = context.base
        return TruthReading(base.pose2, context.twist, math.acos(min(base.pose.item(2, 2), 1.0)))


class WheelEncoders:
    """Measures angles and speeds of the driven wheels."""

    name, frame, on_demand = "wheels", "base_link", False

    def schedule(self, settings: SimulationSettings) -> Schedule:
        return every(None, settings)

    def measure(self, context: SensorContext) -> WheelState:
        return WheelState(*context.wheels)


class ContactSensor:
    """Lists the links (``model::link``) that the robot has touched since the last reading."""

    name, frame, on_demand = "contacts", "world", False

    def schedule(self, settings: SimulationSettings) -> Schedule:
        return every(None, settings)

    def measure(self, context: SensorContext) -> Tuple[str, ...]:
        return tuple(sorted(bump.link for bump in context.bumps))
