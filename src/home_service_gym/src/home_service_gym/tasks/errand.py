"""The home service: fetch an object in one place and deliver it in another."""

from typing import Any, Dict, Sequence

import numpy as np
from gymnasium import spaces

from home_service_gym.approach import Approach
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

# Metres from a zone's middle within which the robot is there, as a mission is judged; m/s at which it stands.
ARRIVED, STANDING = 0.25, 0.05


class Errand:
    """From ``start`` to ``pickup``, where it stands for ``seconds``, then to ``dropoff``, where it stops.

    ``rate``: control periods a second.
    """

    def __init__(self, start: Pose2, pickup: Pose2, dropoff: Pose2, seconds: float, rate: int):
        self._start, self._zones = start, (pickup, dropoff)
        self._periods_to_wait = round(seconds * rate)

    def bodies(self) -> Sequence[Body]:
        return ()

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        return {"goal": goal_space(), "carrying": spaces.MultiBinary(1)}

    def begin(self, playground: Playground, rng: np.random.Generator) -> Beginning:
        self._ground, self._is_carrying, self._waited = playground.ground, False, 0
        self._approach = Approach(self._ground, self._zones[0], self._start)
        return Beginning(self._start)

    def observe(self, moment: Moment) -> Dict[str, np.ndarray]:
        carrying = np.array([self._is_carrying], dtype=np.int8)
        return {"goal": seen_from(moment.base_in_world, self._approach.goal), "carrying": carrying}

    def judge(self, moment: Moment) -> Judgement:
        base = moment.base_in_world
        reward = PERIOD + PROGRESS * self._approach.metres(base)
        is_there = base.distance_to(self._approach.goal) <= ARRIVED and abs(moment.twist.v) < STANDING
        self._waited = self._waited + 1 if is_there else 0
        if self._is_carrying:
            return Judgement(reward + SUCCESS, "success") if is_there else Judgement(reward)
        if self._waited < self._periods_to_wait:
            return Judgement(reward)
        self._is_carrying = True
        self._approach = Approach(self._ground, self._zones[1], base)
        return Judgement(reward + SUCCESS)

    def marks(self) -> Marks:
        return Marks((self._approach.goal, ARRIVED))
