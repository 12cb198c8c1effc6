"""After somebody who walks through a home, as follow_me does."""

from typing import Any, Dict, List, Sequence

import numpy as np
from gymnasium import spaces

from home_service_gym.ground import Ground
from home_service_gym.playground import Moment, Playground
from home_service_gym.task import COLLISION, Beginning, Judgement, Marks, goal_space, seen_from
from laboratory.worlds.solids import post
from planar import Pose2
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.world import Body

# Metres: the gap between the middles that is best, the one at which the leader is lost, the leader itself.
GAP, LOST, RADIUS, HEIGHT = 0.9, 4.0, 0.18, 1.2
# Metres from the origin along both axes: where the leader waits for its first episode.
AWAY = 50.0
# What a period at the best gap is worth; seconds and m/s of the leader's walk.
WORTH, SECONDS, SPEED = 0.1, 120.0, 0.35
# How surely the leader looks for another place to go to rather than turn back.
STUBBORN = 0.95
LEADER = post("leader", Pose2(AWAY, AWAY), RADIUS, HEIGHT, is_kinematic=True)


class Follow:
    """Stay ``GAP`` behind the leader, who walks from one place to another and does not look round."""

    def bodies(self) -> Sequence[Body]:
        return (LEADER,)

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        return {"leader": goal_space()}

    def begin(self, playground: Playground, rng: np.random.Generator) -> Beginning:
        way_xy = _walk(playground.ground, rng)
        along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(way_xy, axis=0).T))))
        ahead = int(np.searchsorted(along, GAP))
        times = (along[ahead:] - along[ahead]) / SPEED
        self._course = ScriptedTrajectory(LEADER.name, times, way_xy[ahead:])
        heading = np.arctan2(*(way_xy[ahead] - way_xy[0])[::-1])
        x, y = way_xy[0].tolist()
        return Beginning(Pose2(x, y, float(heading)), (self._course,))

    def observe(self, moment: Moment) -> Dict[str, np.ndarray]:
        return {"leader": seen_from(moment.base_in_world, self._leader(moment))}

    def judge(self, moment: Moment) -> Judgement:
        gap = moment.base_in_world.distance_to(self._leader(moment))
        if gap > LOST:
            return Judgement(COLLISION, "lost")
        return Judgement(WORTH * max(1.0 - abs(gap - GAP) / GAP, -1.0))

    def marks(self) -> Marks:
        return Marks(trajectories=(self._course,))

    def _leader(self, moment: Moment) -> Pose2:
        return Pose2(*self._course.at(moment.stamp))


def _turns_back(way_xy: np.ndarray, next_xy: np.ndarray) -> bool:
    return float((way_xy[-1] - way_xy[-2]) @ (next_xy[1] - next_xy[0])) < 0.0


def _walk(ground: Ground, rng: np.random.Generator) -> np.ndarray:
    """Points (N, 2) of a way from place to place that takes at least ``SECONDS``."""
    count, length = len(ground.stations), 0.0
    ways: List[np.ndarray] = []
    place = int(rng.integers(count))
    while length < SECONDS * SPEED:
        goal = int(rng.integers(count))
        way_xy = ground.way_between(place, goal)
        if len(way_xy) > 1 and not (ways and _turns_back(ways[-1], way_xy) and rng.random() < STUBBORN):
            length += float(np.hypot(*np.diff(way_xy, axis=0).T).sum())
            ways.append(way_xy)
            place = goal
    return np.concatenate([ways[0], *(way_xy[1:] for way_xy in ways[1:])])
