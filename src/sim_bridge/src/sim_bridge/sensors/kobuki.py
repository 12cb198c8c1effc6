"""What a Kobuki base feels besides its wheels: its bumper, cliffs and wheels that hang."""

from dataclasses import dataclass
from typing import Dict, FrozenSet

import numpy as np

from sim_bridge.config import SimulationSettings
from sim_bridge.geometry.pose3 import transform_points
from sim_bridge.sensors.base import Mounting, Schedule, Surroundings, every
from sim_bridge.sensors.bumper import CENTRE, LEFT, RIGHT, pressed

# Where the cliff sensors look down from, in the base frame, m (kobuki_description).
CLIFF_SENSORS: Dict[int, np.ndarray] = {
    LEFT: np.array([0.08734, 0.13601, 0.0316]),
    CENTRE: np.array([0.156, 0.0, 0.0316]),
    RIGHT: np.array([0.085, -0.13601, 0.0316]),
}
# A wheel hangs if the floor is so much farther below its hub than its radius, m.
WHEEL_DROP = 0.02


@dataclass(frozen=True)
class KobukiReading:
    """``bumpers``, ``cliffs``: sectors (left 0, centre 1, right 2) touched, or without a floor below.

    ``dropped``: wheels (left 0, right 1) that hang.
    """

    bumpers: FrozenSet[int] = frozenset()
    cliffs: FrozenSet[int] = frozenset()
    dropped: FrozenSet[int] = frozenset()


@dataclass(frozen=True, eq=False)
class KobukiProfile:
    """``cliff_threshold``: of the range to the floor, m. ``hubs_xyz``: (2, 3), of the left and right wheel.

    The hubs are seen from the base frame, with ``wheel_radius`` in m.
    """

    hubs_xyz: np.ndarray
    wheel_radius: float
    cliff_threshold: float = 0.04

    def build(self, mounting: Mounting) -> "KobukiSensors":
        return KobukiSensors(self)


class KobukiSensors:
    """Reads the sensors of a base."""

    name, frame, on_demand = "kobuki", "base_link", True

    def __init__(self, profile: KobukiProfile):
        self._downward_xyz = np.vstack([*CLIFF_SENSORS.values(), profile.hubs_xyz])
        self._limits = [profile.cliff_threshold] * len(CLIFF_SENSORS)
        self._limits += [profile.wheel_radius + WHEEL_DROP] * len(profile.hubs_xyz)

    def schedule(self, settings: SimulationSettings) -> Schedule:
        return every(None, settings)

    def measure(self, around: Surroundings) -> KobukiReading:
        base_in_world = around.base.pose
        points = transform_points(base_in_world, self._downward_xyz).tolist()
        floors = around.floors_below(points)
        is_deep = [z - floor >= limit for (_, _, z), floor, limit in zip(points, floors, self._limits)]
        bumpers: FrozenSet[int] = frozenset()
        if around.bumps:
            touched = np.array([bump.point for bump in around.bumps])
            bumpers = pressed(transform_points(np.linalg.inv(base_in_world), touched))
        if not any(is_deep):
            return KobukiReading(bumpers)
        cliffs = (sector for sector, deep in zip(CLIFF_SENSORS, is_deep) if deep)
        dropped = (wheel for wheel, deep in enumerate(is_deep[len(CLIFF_SENSORS) :]) if deep)
        return KobukiReading(bumpers, frozenset(cliffs), frozenset(dropped))
