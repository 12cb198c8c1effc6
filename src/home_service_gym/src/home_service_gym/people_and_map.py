"""Task wrapper that adds the nearest pedestrians and the map around the robot to the observations."""

from typing import Any, Dict, Sequence

import numpy as np
from gymnasium import spaces

from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState
from home_service_gym.maps.egocentric_map import EgocentricMap, map_space
from home_service_gym.task import MAX_GOAL_DISTANCE, EpisodeStart, EpisodeTask, Overlay, TaskStep
from planar import Pose2, SettingsError
from sim_bridge.world import Body

# Row of a missing pedestrian: far ahead and at rest. Upper bound of speeds [m/s].
NOBODY = (MAX_GOAL_DISTANCE, 0.0, 0.0, 0.0)
MAX_SPEED = 5.0


class PeopleAndMapTask:
    """A task with additional observations.

    Args:
        task: Task to wrap.
        people: Number of nearest pedestrians to observe.
        has_map: Whether the map around the robot is observed.
    """

    def __init__(self, task: EpisodeTask, people: int, has_map: bool):
        if people < 0:
            raise SettingsError(f"people must not be negative, got {people}")
        if has_map and "map" in task.spaces():
            raise SettingsError("has_map: this task already observes a map")
        self._task, self._people, self._has_map = task, people, has_map

    def bodies(self) -> Sequence[Body]:
        return self._task.bodies()

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        entries = dict(self._task.spaces())
        if self._people:
            most = np.array((MAX_GOAL_DISTANCE, MAX_GOAL_DISTANCE, MAX_SPEED, MAX_SPEED), np.float32)
            most = np.tile(most, (self._people, 1))
            entries["people"] = spaces.Box(-most, most, dtype=np.float32)
        if self._has_map:
            entries["map"] = map_space()
        return entries

    def reset(self, simulation: EpisodeSimulation, rng: np.random.Generator) -> EpisodeStart:
        if self._has_map:
            self._map = EgocentricMap(simulation.traversable_space.grid)
        return self._task.reset(simulation, rng)

    def observation(self, state: EpisodeState) -> Dict[str, np.ndarray]:
        observation = dict(self._task.observation(state))
        if self._people:
            observation["people"] = nearest_people(state.people, state.base_in_world, self._people)
        if self._has_map:
            observation["map"] = self._map.view_from(state.base_in_world)
        return observation

    def step(self, state: EpisodeState) -> TaskStep:
        return self._task.step(state)

    def overlay(self) -> Overlay:
        return self._task.overlay()


def nearest_people(people: np.ndarray, base: Pose2, count: int) -> np.ndarray:
    """Return the nearest pedestrians in the robot's frame.

    Args:
        people: (N, 5) x, y, velocity in x and y, radius of each pedestrian in the world frame.
        base: Robot pose in the world frame.
        count: Number of rows to return.

    Returns:
        (count, 4) float32: position [m] and velocity over the floor [m/s], forward and to the left.
    """
    rows = np.tile(np.array(NOBODY, np.float32), (count, 1))
    inverse = base.inverse()
    places_xy = inverse.transform_points(people[:, :2])
    order = np.argsort(np.hypot(*places_xy.T), kind="stable")[:count]
    velocities = Pose2(0.0, 0.0, inverse.yaw).transform_points(people[order, 2:4])
    rows[: len(order), :2] = np.clip(places_xy[order], -MAX_GOAL_DISTANCE, MAX_GOAL_DISTANCE)
    rows[: len(order), 2:] = np.clip(velocities, -MAX_SPEED, MAX_SPEED)
    return rows
