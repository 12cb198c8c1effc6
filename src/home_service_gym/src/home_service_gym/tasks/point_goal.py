"""Point goal navigation: from a random pose to a random goal."""

from typing import Any, Dict, Sequence

import numpy as np
from gymnasium import spaces

from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState
from home_service_gym.task import (
    MAX_GOAL_DISTANCE,
    PERIOD_REWARD,
    PROGRESS_REWARD,
    SUCCESS_REWARD,
    EpisodeStart,
    Overlay,
    TaskStep,
    goal_observation,
    goal_space,
)
from home_service_gym.traversable_space import DistanceToGoal
from sim_bridge.world import Body


class PointGoalTask:
    """Reach a random goal.

    Args:
        radius: Distance at which the goal counts as reached [m].
        min_path_length: Minimum length of the shortest path [m].
        lookahead: Distance along the shortest path of the observed ``waypoint`` [m]; 0: none is observed.
    """

    def __init__(self, radius: float = 0.3, min_path_length: float = 1.0, lookahead: float = 0.0):
        self._radius, self._min_path_length, self._lookahead = radius, min_path_length, lookahead

    def bodies(self) -> Sequence[Body]:
        return ()

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        entries: Dict[str, spaces.Space[Any]] = {"goal": goal_space()}
        if self._lookahead:
            entries["waypoint"] = spaces.Box(-MAX_GOAL_DISTANCE, MAX_GOAL_DISTANCE, (2,), np.float32)
        return entries

    def reset(self, simulation: EpisodeSimulation, rng: np.random.Generator) -> EpisodeStart:
        traversable_space = simulation.traversable_space
        goal = traversable_space.sample_pose(rng)
        start = traversable_space.sample_pose(
            rng, traversable_space.distances_to(goal), self._min_path_length
        )
        self._distance_to_goal = DistanceToGoal(traversable_space, goal, start)
        return EpisodeStart(start)

    def observation(self, state: EpisodeState) -> Dict[str, np.ndarray]:
        base = state.base_in_world
        observation = {"goal": goal_observation(base, self._distance_to_goal.goal)}
        if self._lookahead:
            observation["waypoint"] = self._distance_to_goal.waypoint(base, self._lookahead).astype(
                np.float32
            )
        return observation

    def step(self, state: EpisodeState) -> TaskStep:
        reward = PERIOD_REWARD + PROGRESS_REWARD * self._distance_to_goal.decrease(state.base_in_world)
        if state.base_in_world.distance_to(self._distance_to_goal.goal) <= self._radius:
            return TaskStep(reward + SUCCESS_REWARD, "success")
        return TaskStep(reward)

    def overlay(self) -> Overlay:
        return Overlay((self._distance_to_goal.goal, self._radius))
