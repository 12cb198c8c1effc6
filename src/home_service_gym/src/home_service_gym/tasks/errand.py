"""The errand: wait in the pick-up zone, then drive to the drop-off zone."""

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
from home_service_gym.traversable_space import DistanceToGoal
from planar import Pose2
from sim_bridge.world import Body

# Radius of a zone as in missions [m]; speed below which the robot counts as standing [m/s].
GOAL_RADIUS, STOPPED_SPEED = 0.25, 0.05


class ErrandTask:
    """Wait at the pick-up pose, then stop at the drop-off pose.

    Args:
        start: Start pose in the world frame.
        pickup: Pick-up pose in the world frame.
        dropoff: Drop-off pose in the world frame.
        seconds: Time to wait at the pick-up pose [s].
        rate: Control rate [Hz].
    """

    def __init__(self, start: Pose2, pickup: Pose2, dropoff: Pose2, seconds: float, rate: int):
        self._start, self._zones = start, (pickup, dropoff)
        self._periods_to_wait = round(seconds * rate)

    def bodies(self) -> Sequence[Body]:
        return ()

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        return {"goal": goal_space(), "carrying": spaces.MultiBinary(1)}

    def reset(self, simulation: EpisodeSimulation, rng: np.random.Generator) -> EpisodeStart:
        self._traversable_space, self._is_carrying, self._waited = simulation.traversable_space, False, 0
        self._distance_to_goal = DistanceToGoal(self._traversable_space, self._zones[0], self._start)
        return EpisodeStart(self._start)

    def observation(self, state: EpisodeState) -> Dict[str, np.ndarray]:
        carrying = np.array([self._is_carrying], dtype=np.int8)
        return {
            "goal": goal_observation(state.base_in_world, self._distance_to_goal.goal),
            "carrying": carrying,
        }

    def step(self, state: EpisodeState) -> TaskStep:
        base = state.base_in_world
        reward = PERIOD_REWARD + PROGRESS_REWARD * self._distance_to_goal.decrease(base)
        is_in_zone = (
            base.distance_to(self._distance_to_goal.goal) <= GOAL_RADIUS
            and abs(state.twist.v) < STOPPED_SPEED
        )
        self._waited = self._waited + 1 if is_in_zone else 0
        if self._is_carrying:
            return TaskStep(reward + SUCCESS_REWARD, "success") if is_in_zone else TaskStep(reward)
        if self._waited < self._periods_to_wait:
            return TaskStep(reward)
        self._is_carrying = True
        self._distance_to_goal = DistanceToGoal(self._traversable_space, self._zones[1], base)
        return TaskStep(reward + SUCCESS_REWARD)

    def overlay(self) -> Overlay:
        return Overlay((self._distance_to_goal.goal, GOAL_RADIUS))
