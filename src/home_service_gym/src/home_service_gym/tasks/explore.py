"""Exploration of an unknown home."""

from typing import Any, Dict, Sequence

import numpy as np
from gymnasium import spaces

from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState
from home_service_gym.maps.egocentric_map import EgocentricMap, map_space
from home_service_gym.maps.explored_area import ExploredArea
from home_service_gym.task import PERIOD_REWARD, SUCCESS_REWARD, EpisodeStart, Overlay, TaskStep
from sim_bridge.world import Body

# Share of the free area that completes the task; reward for each newly explored square metre.
COMPLETE_SHARE, AREA_REWARD = 0.95, 1.0


class ExploreTask:
    """Explore a home from a random pose; the explored part of the true map is observed."""

    def bodies(self) -> Sequence[Body]:
        return ()

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        return {"map": map_space()}

    def reset(self, simulation: EpisodeSimulation, rng: np.random.Generator) -> EpisodeStart:
        traversable_space = simulation.traversable_space
        self._map, self._explored_area = (
            EgocentricMap(traversable_space.grid),
            ExploredArea(traversable_space.grid),
        )
        return EpisodeStart(traversable_space.sample_pose(rng))

    def observation(self, state: EpisodeState) -> Dict[str, np.ndarray]:
        if not self._explored_area.share:
            self._explored_area.add_scan(state.base_in_world, state.scan)
        return {"map": self._map.view_from(state.base_in_world, self._explored_area.explored)}

    def step(self, state: EpisodeState) -> TaskStep:
        reward = PERIOD_REWARD + AREA_REWARD * self._explored_area.add_scan(state.base_in_world, state.scan)
        is_done = self._explored_area.share >= COMPLETE_SHARE
        return TaskStep(reward + SUCCESS_REWARD, "success") if is_done else TaskStep(reward)

    def overlay(self) -> Overlay:
        return Overlay(explored=self._explored_area.explored)
