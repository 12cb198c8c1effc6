"""Sensors of a Kobuki base: bumper, cliff sensors and wheel drops (kobuki_gazebo_plugins)."""

import math
from dataclasses import dataclass, field
from typing import Dict, FrozenSet, Optional

import numpy as np

from sim_bridge.config import SimulationSettings
from sim_bridge.geometry.pose3 import transform_points
from sim_bridge.power.system import PowerReading
from sim_bridge.sensors.base import Mounting, Schedule, SensorContext, every

LEFT, CENTRE, RIGHT = 0, 1, 2
# Bearings of each sector of the bumper [rad], and its heights [m], in the base frame.
SECTORS = {
    LEFT: (math.radians(30.0), math.radians(90.0)),
    CENTRE: (-math.radians(30.0), math.radians(30.0)),
    RIGHT: (-math.radians(90.0), -math.radians(30.0)),
}
# Bits of the bumpers and cliff sensors in kobuki_msgs/SensorState.
SECTOR_BITS = {RIGHT: 1, CENTRE: 2, LEFT: 4}
LOWEST, HIGHEST = 0.01, 0.13
# Positions of the cliff sensors in the base frame [m] (kobuki_description).
CLIFF_SENSORS: Dict[int, np.ndarray] = {
    LEFT: np.array([0.08734, 0.13601, 0.0316]),
    CENTRE: np.array([0.156, 0.0, 0.0316]),
    RIGHT: np.array([0.085, -0.13601, 0.0316]),
}
# A wheel has dropped if the floor is so much farther below its hub than its radius [m].
WHEEL_DROP = 0.02


@dataclass(frozen=True)
class KobukiReading:
    """State of a Kobuki's sensors; sectors are left 0, centre 1, right 2 (kobuki_msgs).

    Attributes:
        bumpers: Pressed sectors.
        cliffs: Sectors without a floor below.
        dropped: Dropped wheels: left 0, right 1.
        power: State of the power system.
    """

    bumpers: FrozenSet[int] = frozenset()
    cliffs: FrozenSet[int] = frozenset()
    dropped: FrozenSet[int] = frozenset()
    power: Optional[PowerReading] = field(default=None, compare=False)


@dataclass(frozen=True, eq=False)
class KobukiProfile:
    """Settings of a Kobuki's sensors.

    Attributes:
        hubs_xyz: Hubs (2, 3) of the left and right wheel in the base frame [m].
        wheel_radius: Radius of the wheels [m].
        cliff_threshold: Distance to the floor from which there is a cliff [m].
    """

    hubs_xyz: np.ndarray
    wheel_radius: float
    cliff_threshold: float = 0.04

    def build(self, mounting: Mounting) -> "KobukiSensors":
        return KobukiSensors(self)


class KobukiSensors:
    """Measures bumper, cliffs and wheel drops."""

    name, frame, on_demand = "kobuki", "base_link", True

    def __init__(self, profile: KobukiProfile):
        self._downward_xyz = np.vstack([*CLIFF_SENSORS.values(), profile.hubs_xyz])
        self._limits = [profile.cliff_threshold] * len(CLIFF_SENSORS)
        self._limits += [profile.wheel_radius + WHEEL_DROP] * len(profile.hubs_xyz)

    def schedule(self, settings: SimulationSettings) -> Schedule:
        return every(None, settings)

    def measure(self, context: SensorContext) -> KobukiReading:
        base_in_world = context.base.pose
        points = transform_points(base_in_world, self._downward_xyz).tolist()
        floors = context.floors_below(points)
        is_deep = [z - floor >= limit for (_, _, z), floor, limit in zip(points, floors, self._limits)]
        bumpers: FrozenSet[int] = frozenset()
        if context.bumps:
            touched = np.array([bump.point for bump in context.bumps])
            bumpers = pressed(transform_points(np.linalg.inv(base_in_world), touched))
        if not any(is_deep):
            return KobukiReading(bumpers, power=context.power)
        cliffs = (sector for sector, deep in zip(CLIFF_SENSORS, is_deep) if deep)
        dropped = (wheel for wheel, deep in enumerate(is_deep[len(CLIFF_SENSORS) :]) if deep)
        return KobukiReading(bumpers, frozenset(cliffs), frozenset(dropped), context.power)


def pressed(contacts_xyz: np.ndarray) -> FrozenSet[int]:
    """Return the pressed sectors of the bumper.

    Args:
        contacts_xyz: Contacts (N, 3) of the robot in its base frame [m].
    """
    x, y, z = np.asarray(contacts_xyz, dtype=float).reshape(-1, 3).T
    bearings = np.arctan2(y, x)[(z >= LOWEST) & (z <= HIGHEST)]
    return frozenset(
        sector
        for sector, (first, last) in SECTORS.items()
        if ((bearings >= first) & (bearings <= last)).any()
    )
