"""To a place ahead without a map, as in BARN and DynaBARN."""

from typing import Any, Dict, Sequence

import numpy as np
from gymnasium import spaces

from home_service_gym.playground import Moment, Playground
from home_service_gym.task import (
    PERIOD,
    PROGRESS,
    SUCCESS,
    Beginning,
    Judgement,
    Marks,
    goal_space,
    seen_from,
)
from planar import Pose2
from sim_bridge.world import Body


class Reach:
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

    def begin(self, playground: Playground, rng: np.random.Generator) -> Beginning:
        self._left = self._start.distance_to(self._goal)
        self._trajectories = playground.arena.world.trajectories
        return Beginning(self._start)

    def observe(self, moment: Moment) -> Dict[str, np.ndarray]:
        return {"goal": seen_from(moment.base_in_odom, self._goal_in_odom)}

    def judge(self, moment: Moment) -> Judgement:
        left = moment.base_in_world.distance_to(self._goal)
        reward = PERIOD + PROGRESS * (self._left - left)
        self._left = left
        return Judgement(reward + SUCCESS, "success") if left <= self._radius else Judgement(reward)

    def marks(self) -> Marks:
        return Marks((self._goal, self._radius), self._trajectories)
