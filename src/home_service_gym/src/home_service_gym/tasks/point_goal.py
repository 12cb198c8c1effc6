"""To a goal anywhere in a home, from anywhere."""

from typing import Any, Dict, Sequence

import numpy as np
from gymnasium import spaces

from home_service_gym.approach import Approach
from home_service_gym.playground import Moment, Playground
from home_service_gym.task import (
    FARTHEST_GOAL,
    PERIOD,
    PROGRESS,
    SUCCESS,
    Beginning,
    Judgement,
    Marks,
    goal_space,
    seen_from,
)
from sim_bridge.world import Body


class PointGoal:
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
            told["waypoint"] = spaces.Box(-FARTHEST_GOAL, FARTHEST_GOAL, (2,), np.float32)
        return told

    def begin(self, playground: Playground, rng: np.random.Generator) -> Beginning:
        ground = playground.ground
        goal = ground.place(rng)
        start = ground.place(rng, ground.distances_to(goal), self._least_way)
        self._approach = Approach(ground, goal, start)
        return Beginning(start)

    def observe(self, moment: Moment) -> Dict[str, np.ndarray]:
        base = moment.base_in_world
        told = {"goal": seen_from(base, self._approach.goal)}
        if self._lookahead:
            told["waypoint"] = self._approach.ahead(base, self._lookahead).astype(np.float32)
        return told

    def judge(self, moment: Moment) -> Judgement:
        reward = PERIOD + PROGRESS * self._approach.metres(moment.base_in_world)
        if moment.base_in_world.distance_to(self._approach.goal) <= self._radius:
            return Judgement(reward + SUCCESS, "success")
        return Judgement(reward)

    def marks(self) -> Marks:
        return Marks((self._approach.goal, self._radius))
