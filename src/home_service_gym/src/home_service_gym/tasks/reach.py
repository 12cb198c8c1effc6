"""To a place ahead without a map, as in BARN and DynaBARN."""

from typing import Any, Dict, Sequence

import numpy as np
from gymnasium import spaces

from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState
from home_service_gym.task import (
    PERIOD_REWARD,
    PROGRESS_REWARD,
    SUCCESS_REWARD,
    EpisodeStart,
    Overlay,
    TaskStep,
    goal_observation,
    goal_space,
)
from planar import Pose2
from sim_bridge.world import Body


class ReachTask:
    """``goal_in_odom`` is seen from ``start``; within ``radius``, m, of it the robot has arrived.

    The robot is told of the goal by its odometry, and judged by the truth.
    """

    def __init__(self, start: Pose2, goal_in_odom: Pose2, radius: float):
        self._start, self._goal_in_odom, self._radius = start, goal_in_odom, radius
        self._goal = start @ goal_in_odom

    def bodies(self) -> Sequence[Body]:
        return ()

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        return {"goal": goal_space()}

    def reset(self, simulation: EpisodeSimulation, rng: np.random.Generator) -> EpisodeStart:
        self._left = self._start.distance_to(self._goal)
        self._trajectories = simulation.arena.world.trajectories
        return EpisodeStart(self._start)

    def observation(self, state: EpisodeState) -> Dict[str, np.ndarray]:
        return {"goal": goal_observation(state.base_in_odom, self._goal_in_odom)}

    def step(self, state: EpisodeState) -> TaskStep:
        left = state.base_in_world.distance_to(self._goal)
        reward = PERIOD_REWARD + PROGRESS_REWARD * (self._left - left)
        self._left = left
        return TaskStep(reward + SUCCESS_REWARD, "success") if left <= self._radius else TaskStep(reward)

    def overlay(self) -> Overlay:
        return Overlay((self._goal, self._radius), self._trajectories)
