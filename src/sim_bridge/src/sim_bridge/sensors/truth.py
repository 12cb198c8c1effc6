"""What is true of a robot, as sensors that never err."""

import math
from dataclasses import dataclass
from typing import Tuple

from planar import Pose2, Twist2
from sim_bridge.config import SimulationSettings
from sim_bridge.sensors.base import Schedule, Surroundings, every


@dataclass(frozen=True)
class Truth:
    """``tilt``: between the robot's axis and the vertical, rad."""

    base_in_world: Pose2
    twist: Twist2
    tilt: float


@dataclass(frozen=True)
class WheelState:
    """Of the driven wheels, those on the left first, rad and rad/s."""

    angles: Tuple[float, ...]
    speeds: Tuple[float, ...]


class GroundTruth:
    """Where the robot is."""

    name, frame, on_demand = "ground_truth", "world", False

    def schedule(self, settings: SimulationSettings) -> Schedule:
        return every(None, settings)

    def measure(self, around: Surroundings) -> Truth:
        base = around.base
        return Truth(base.pose2, around.twist, math.acos(min(base.pose.item(2, 2), 1.0)))


class JointEncoders:
    """How far and how fast the wheels turn."""

    name, frame, on_demand = "wheels", "base_link", False

    def schedule(self, settings: SimulationSettings) -> Schedule:
        return every(None, settings)

    def measure(self, around: Surroundings) -> WheelState:
        return WheelState(*around.wheels)


class ContactList:
    """The names (``model::link``) of what the robot has bumped into since it last told."""

    name, frame, on_demand = "contacts", "world", False

    def schedule(self, settings: SimulationSettings) -> Schedule:
        return every(None, settings)

    def measure(self, around: Surroundings) -> Tuple[str, ...]:
        return tuple(sorted(bump.link for bump in around.bumps))
