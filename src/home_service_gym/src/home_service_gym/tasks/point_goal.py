"""To a goal anywhere in a home, from anywhere."""

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
    """Within ``radius``, m, of the goal is there; the way to it has at least ``least_way``, m.

    ``lookahead``: also the point that far, m, ahead on the shortest way is told; 0: it is not.
    """

    def __init__(self, radius: float = 0.3, least_way: float = 1.0, lookahead: float = 0.0):
        self._radius, self._least_way, self._lookahead = radius, least_way, lookahead

    def bodies(self) -> Sequence[Body]:
        return ()

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        told: Dict[str, spaces.Space[Any]] = {"goal": goal_space()}
        if self._lookahead:
            told["waypoint"] = spaces.Box(-MAX_GOAL_DISTANCE, MAX_GOAL_DISTANCE, (2,), np.float32)
        return told

    def reset(self, simulation: EpisodeSimulation, rng: np.random.Generator) -> EpisodeStart:
        traversable_space = simulation.traversable_space
        goal = traversable_space.sample_pose(rng)
        start = traversable_space.sample_pose(rng, traversable_space.distances_to(goal), self._least_way)
        self._distance_to_goal = DistanceToGoal(traversable_space, goal, start)
        return EpisodeStart(start)

    def observation(self, state: EpisodeState) -> Dict[str, np.ndarray]:
        base = state.base_in_world
        told = {"goal": goal_observation(base, self._distance_to_goal.goal)}
        if self._lookahead:
            told["waypoint"] = self._distance_to_goal.waypoint(base, self._lookahead).astype(np.float32)
        return told

    def step(self, state: EpisodeState) -> TaskStep:
        reward = PERIOD_REWARD + PROGRESS_REWARD * self._distance_to_goal.decrease(state.base_in_world)
        if state.base_in_world.distance_to(self._distance_to_goal.goal) <= self._radius:
            return TaskStep(reward + SUCCESS_REWARD, "success")
        return TaskStep(reward)

    def overlay(self) -> Overlay:
        return Overlay((self._distance_to_goal.goal, self._radius))
