"""See all of a home that nobody has told about."""

import math
from typing import Any, Dict, Sequence

import numba
import numpy as np
from gymnasium import spaces

from home_service_gym.around import map_around, map_space
from home_service_gym.playground import Moment, Playground
from home_service_gym.task import PERIOD, SUCCESS, Beginning, Judgement, Marks
from planar import FREE, OCCUPIED
from sim_bridge.world import Body

# The share of all free floor that is enough; what a square metre that was not known is worth.
ENOUGH, AREA = 0.95, 1.0


class Explore:
    """The robot is told which cells of the true map its lidar has reached; it is put anywhere."""

    def bodies(self) -> Sequence[Body]:
        return ()

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        return {"map": map_space()}

    def begin(self, playground: Playground, rng: np.random.Generator) -> Beginning:
        self._grid = playground.ground.grid
        self._known = np.zeros(self._grid.cells.shape, dtype=np.bool_)
        self._all = int(np.count_nonzero(self._grid.cells == FREE))
        self._seen = 0
        return Beginning(playground.ground.place(rng))

    def observe(self, moment: Moment) -> Dict[str, np.ndarray]:
        if not self._seen:
            self._see(moment)
        return {"map": map_around(self._grid, moment.base_in_world, self._known)}

    def judge(self, moment: Moment) -> Judgement:
        before = self._seen
        self._see(moment)
        reward = PERIOD + AREA * (self._seen - before) * self._grid.resolution**2
        is_done = self._seen >= ENOUGH * self._all
        return Judgement(reward + SUCCESS, "success") if is_done else Judgement(reward)

    def marks(self) -> Marks:
        return Marks(known=self._known)

    def _see(self, moment: Moment) -> None:
        """Takes in what the beams have gone through, and what they have met."""
        scan, grid = moment.scan, self._grid
        laser = grid.origin.inverse() @ moment.base_in_world @ scan.laser_in_base
        reached = np.clip(scan.ranges, 0.0, scan.range_max) / grid.resolution
        place = laser.x / grid.resolution, laser.y / grid.resolution
        self._seen += _mark(grid.cells, self._known, *place, laser.yaw + scan.angles, reached)


@numba.njit(cache=True)
def _mark(cells, known, x, y, angles, reached):
    """Marks what lies along beams as known, half a cell at a time; returns how much free floor is new."""
    rows, cols = cells.shape
    news = 0
    for beam in range(angles.size):
        dx, dy = math.cos(angles[beam]), math.sin(angles[beam])
        for half in range(2 * int(reached[beam]) + 3):
            row, col = math.floor(y + 0.5 * half * dy), math.floor(x + 0.5 * half * dx)
            if not (0 <= row < rows and 0 <= col < cols):
                break
            if not known[row, col]:
                known[row, col] = True
                news += cells[row, col] == FREE
            if cells[row, col] == OCCUPIED:
                break
    return news
