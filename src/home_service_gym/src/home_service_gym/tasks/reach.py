"""A goal in the odometry frame without a map, as in BARN and DynaBARN."""

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
    """Reach a goal. It is observed through odometry; rewards use the true pose.

    Args:
        start: Start pose in the world frame.
        goal_in_odom: Goal pose in the frame of the start pose.
        radius: Distance at which the goal counts as reached [m].
    """

    def __init__(self, start: Pose2, goal_in_odom: Pose2, radius: float):
        self._start, self._goal_in_odom, self._radius = start, goal_in_odom, radius
        self._goal = start @ goal_in_odom

    def bodies(self) -> Sequence[Body]:
        return ()

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        return {"goal": goal_space()}

    def reset(self, simulation: EpisodeSimulation, rng: np.random.Generator) -> EpisodeStart:
        self._remaining = self._start.distance_to(self._goal)
        self._trajectories = simulation.arena.world.trajectories
        return EpisodeStart(self._start)

    def observation(self, state: EpisodeState) -> Dict[str, np.ndarray]:
        return {"goal": goal_observation(state.base_in_odom, self._goal_in_odom)}

    def step(self, state: EpisodeState) -> TaskStep:
        remaining = state.base_in_world.distance_to(self._goal)
        reward = PERIOD_REWARD + PROGRESS_REWARD * (self._remaining - remaining)
        self._remaining = remaining
        return TaskStep(reward + SUCCESS_REWARD, "success") if remaining <= self._radius else TaskStep(reward)

    def overlay(self) -> Overlay:
        return Overlay((self._goal, self._radius), self._trajectories)
