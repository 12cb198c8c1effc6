"""A task whose robot is told of its surroundings, too: who is near, and what the map is like there."""

from typing import Any, Dict, Sequence

import numpy as np
from gymnasium import spaces

from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState
from home_service_gym.maps.egocentric_map import EgocentricMap, map_space
from home_service_gym.task import MAX_GOAL_DISTANCE, EpisodeStart, EpisodeTask, Overlay, TaskStep
from planar import Pose2, SettingsError
from sim_bridge.world import Body

# Of nobody: far ahead, and at rest. m/s, which nobody exceeds.
NOBODY = (MAX_GOAL_DISTANCE, 0.0, 0.0, 0.0)
FASTEST = 5.0


class PeopleAndMapTask:
    """``task`` with the nearest ``people``, so many of them, and with a picture of the map if it ``has_map``.

    Both are the truth, whether the robot sees them or not. Raises SettingsError.
    """

    def __init__(self, task: EpisodeTask, people: int, has_map: bool):
        if people < 0:
            raise SettingsError(f"people must not be negative, got {people}")
        if has_map and "map" in task.spaces():
            raise SettingsError("has_map: this task tells of a map of its own")
        self._task, self._people, self._has_map = task, people, has_map

    def bodies(self) -> Sequence[Body]:
        return self._task.bodies()

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        told = dict(self._task.spaces())
        if self._people:
            most = np.array((MAX_GOAL_DISTANCE, MAX_GOAL_DISTANCE, FASTEST, FASTEST), np.float32)
            most = np.tile(most, (self._people, 1))
            told["people"] = spaces.Box(-most, most, dtype=np.float32)
        if self._has_map:
            told["map"] = map_space()
        return told

    def reset(self, simulation: EpisodeSimulation, rng: np.random.Generator) -> EpisodeStart:
        if self._has_map:
            self._map = EgocentricMap(simulation.traversable_space.grid)
        return self._task.reset(simulation, rng)

    def observation(self, state: EpisodeState) -> Dict[str, np.ndarray]:
        told = dict(self._task.observation(state))
        if self._people:
            told["people"] = nearest_people(state.people, state.base_in_world, self._people)
        if self._has_map:
            told["map"] = self._map.view_from(state.base_in_world)
        return told

    def step(self, state: EpisodeState) -> TaskStep:
        return self._task.step(state)

    def overlay(self) -> Overlay:
        return self._task.overlay()


def nearest_people(people: np.ndarray, base: Pose2, count: int) -> np.ndarray:
    """Of ``people`` (N, 5) the nearest, as the robot's frame has them: (count, 4), float32.

    Place, m, and velocity over the floor, m/s, ahead and to the left of each.
    """
    seen = np.tile(np.array(NOBODY, np.float32), (count, 1))
    inverse = base.inverse()
    places_xy = inverse.transform_points(people[:, :2])
    order = np.argsort(np.hypot(*places_xy.T), kind="stable")[:count]
    velocities = Pose2(0.0, 0.0, inverse.yaw).transform_points(people[order, 2:4])
    seen[: len(order), :2] = np.clip(places_xy[order], -MAX_GOAL_DISTANCE, MAX_GOAL_DISTANCE)
    seen[: len(order), 2:] = np.clip(velocities, -FASTEST, FASTEST)
    return seen
