"""Boxes that a map does not show."""

import math
from dataclasses import replace
from typing import List, Sequence

import numpy as np

from laboratory.worlds.source import Arena
from planar import FREE, Pose2, SettingsError
from planar.geometry.distance_field import distance_field
from sim_bridge.simulation import box_on_floor
from sim_bridge.world import Body

SIZE = (0.35, 0.35, 0.5)
# Metres: from a box's middle to a wall, so that a robot gets past, to another box, and to start and goals.
TO_WALL, TO_OTHERS, TO_PLACES = 0.75, 1.2, 1.0
_STREAM = 41


def with_boxes(arena: Arena, count: int, seed: int, places: Sequence[Pose2]) -> Arena:
    """The arena with so many boxes anywhere off its walls and off ``places``.

    Raises SettingsError if the arena has no map or no room for them.
    """
    if arena.grid is None:
        raise SettingsError("boxes need a world with a map")
    rng = np.random.default_rng([seed, _STREAM])
    clearance = distance_field(arena.grid.cells != FREE, arena.grid.resolution)
    spots_xy = arena.grid.points_of(np.argwhere(clearance > TO_WALL))
    for place in places:
        spots_xy = spots_xy[np.hypot(*(spots_xy - (place.x, place.y)).T) > TO_PLACES]
    boxes: List[Body] = []
    for number in range(count):
        if not len(spots_xy):
            raise SettingsError(f"there is room for {number} boxes only, not for {count}")
        x, y = spots_xy[rng.integers(len(spots_xy))]
        pose = Pose2(float(x), float(y), float(rng.uniform(-math.pi, math.pi)))
        boxes.append(box_on_floor(f"box_{number}", SIZE, pose))
        spots_xy = spots_xy[np.hypot(*(spots_xy - (x, y)).T) > TO_OTHERS]
    return replace(arena, world=replace(arena.world, bodies=(*arena.world.bodies, *boxes)))
