"""Following a person who walks through a home, as follow_me does."""

from typing import Any, Dict, List, Sequence

import numpy as np
from gymnasium import spaces

from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState
from home_service_gym.task import (
    COLLISION_REWARD,
    EpisodeStart,
    Overlay,
    TaskStep,
    goal_observation,
    goal_space,
)
from home_service_gym.traversable_space import TraversableSpace
from laboratory.worlds.solids import post
from planar import Pose2
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.world import Body

# Metres: best distance to the leader, distance at which the leader is lost, radius and height of the leader.
BEST_GAP, MAX_GAP, RADIUS, HEIGHT = 0.9, 4.0, 0.18, 1.2
# Position of the leader before its first episode, outside of the home [m].
PARKING_COORDINATE = 50.0
# Reward of a period at the best distance; duration [s] and speed [m/s] of the leader.
GAP_REWARD, SECONDS, SPEED = 0.1, 120.0, 0.35
# Probability that the leader chooses another goal instead of turning back.
KEEP_DIRECTION_PROBABILITY = 0.95
LEADER = post("leader", Pose2(PARKING_COORDINATE, PARKING_COORDINATE), RADIUS, HEIGHT, is_kinematic=True)


class FollowTask:
    """Stay ``BEST_GAP`` behind a leader who walks between random waypoints."""

    def bodies(self) -> Sequence[Body]:
        return (LEADER,)

    def spaces(self) -> Dict[str, spaces.Space[Any]]:
        return {"leader": goal_space()}

    def reset(self, simulation: EpisodeSimulation, rng: np.random.Generator) -> EpisodeStart:
        path_xy = _leader_path(simulation.traversable_space, rng)
        along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(path_xy, axis=0).T))))
        ahead = int(np.searchsorted(along, BEST_GAP))
        times = (along[ahead:] - along[ahead]) / SPEED
        self._trajectory = ScriptedTrajectory(LEADER.name, times, path_xy[ahead:])
        heading = np.arctan2(*(path_xy[ahead] - path_xy[0])[::-1])
        x, y = path_xy[0].tolist()
        return EpisodeStart(Pose2(x, y, float(heading)), (self._trajectory,))

    def observation(self, state: EpisodeState) -> Dict[str, np.ndarray]:
        return {"leader": goal_observation(state.base_in_world, self._leader(state))}

    def step(self, state: EpisodeState) -> TaskStep:
        gap = state.base_in_world.distance_to(self._leader(state))
        if gap > MAX_GAP:
            return TaskStep(COLLISION_REWARD, "lost")
        return TaskStep(GAP_REWARD * max(1.0 - abs(gap - BEST_GAP) / BEST_GAP, -1.0))

    def overlay(self) -> Overlay:
        return Overlay(trajectories=(self._trajectory,))

    def _leader(self, state: EpisodeState) -> Pose2:
        return Pose2(*self._trajectory.at(state.stamp))


def _turns_back(path_xy: np.ndarray, next_xy: np.ndarray) -> bool:
    return float((path_xy[-1] - path_xy[-2]) @ (next_xy[1] - next_xy[0])) < 0.0


def _leader_path(traversable_space: TraversableSpace, rng: np.random.Generator) -> np.ndarray:
    """Points (N, 2) of a path between random waypoints that takes at least ``SECONDS``."""
    count, length = len(traversable_space.waypoints), 0.0
    paths: List[np.ndarray] = []
    place = int(rng.integers(count))
    while length < SECONDS * SPEED:
        goal = int(rng.integers(count))
        path_xy = traversable_space.path_between(place, goal)
        if len(path_xy) > 1 and not (
            paths and _turns_back(paths[-1], path_xy) and rng.random() < KEEP_DIRECTION_PROBABILITY
        ):
            length += float(np.hypot(*np.diff(path_xy, axis=0).T).sum())
            paths.append(path_xy)
            place = goal
    return np.concatenate([paths[0], *(path_xy[1:] for path_xy in paths[1:])])
