"""What a Kobuki base feels besides its wheels: its bumper, cliffs and wheels that hang."""

from dataclasses import dataclass
from typing import Dict, FrozenSet, List, Tuple

import numpy as np

from sim_bridge.geometry.pose3 import transform_points
from sim_bridge.physics.engine import Engine
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


class KobukiSensors:
    """Reads the sensors of a base; ``hubs_xyz``: (2, 3), of its left and right wheel, in the base frame."""

    def __init__(self, engine: Engine, cliff_threshold: float, hubs_xyz: np.ndarray, wheel_radius: float):
        self._engine = engine
        self._downward_xyz = np.vstack([*CLIFF_SENSORS.values(), hubs_xyz])
        self._limits = [cliff_threshold] * len(CLIFF_SENSORS) + [wheel_radius + WHEEL_DROP] * len(hubs_xyz)

    def read(
        self, base_in_world: np.ndarray, contacts_xyz: List[Tuple[float, float, float]]
    ) -> KobukiReading:
        """``base_in_world``: (4, 4); ``contacts_xyz``: where the robot touches things, in the world."""
        points = transform_points(base_in_world, self._downward_xyz).tolist()
        floors = self._engine.floors_below(points)
        is_deep = [z - floor >= limit for (_, _, z), floor, limit in zip(points, floors, self._limits)]
        bumpers: FrozenSet[int] = frozenset()
        if contacts_xyz:
            bumpers = pressed(transform_points(np.linalg.inv(base_in_world), np.array(contacts_xyz)))
        if not any(is_deep):
            return KobukiReading(bumpers)
        cliffs = (sector for sector, deep in zip(CLIFF_SENSORS, is_deep) if deep)
        dropped = (wheel for wheel, deep in enumerate(is_deep[len(CLIFF_SENSORS) :]) if deep)
        return KobukiReading(bumpers, frozenset(cliffs), frozenset(dropped))
