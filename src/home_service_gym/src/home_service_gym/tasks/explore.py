"""See all of a home that nobody has told about."""

from typing import Any, Dict, Sequence

import numpy as np
from gymnasium import spaces

from home_service_gym.maps.around import MapAround, map_space
from home_service_gym.maps.discovery import Discovery
from home_service_gym.playground import Moment, Playground
from home_service_gym.task import PERIOD, SUCCESS, Beginning, Judgement, Marks
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
        ground = playground.ground
        self._map, self._discovery = MapAround(ground.grid), Discovery(ground.grid)
        return Beginning(ground.place(rng))

    def observe(self, moment: Moment) -> Dict[str, np.ndarray]:
        if not self._discovery.share:
            self._discovery.see(moment.base_in_world, moment.scan)
        return {"map": self._map.seen_from(moment.base_in_world, self._discovery.known)}

    def judge(self, moment: Moment) -> Judgement:
        reward = PERIOD + AREA * self._discovery.see(moment.base_in_world, moment.scan)
        is_done = self._discovery.share >= ENOUGH
        return Judgement(reward + SUCCESS, "success") if is_done else Judgement(reward)

    def marks(self) -> Marks:
        return Marks(known=self._discovery.known)
