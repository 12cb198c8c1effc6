"""The facade: goals that make one robot follow another."""

import math
from typing import List, Optional

from follow_me.config import FollowSettings
from planar import Pose2, wrap

# Spacing of the points of the leader's path [m].
_SPACING = 0.05
# The leader's motion since the last call is extrapolated by this factor, at most by this share of the gap.
_PREDICTION_STEPS, _MAX_PREDICTION_SHARE = 2.0, 0.3


class LeaderFollower:
    """Computes goals on the leader's path, which is free of obstacles, ``gap`` behind it.

    Once there, the follower stands and turns with the leader, so that it can start at once.

    Args:
        settings: Distances, and when a goal is sent again.
    """

    def __init__(self, settings: FollowSettings):
        self._settings = settings
        self._leader_path: List[Pose2] = []
        self._goal: Optional[Pose2] = None
        self._leader_in_map: Optional[Pose2] = None
        self._leader_step = 0.0
        self._is_driving = False

    def goal(self, leader_in_map: Pose2, follower_in_map: Pose2) -> Optional[Pose2]:
        """Compute the next goal.

        Args:
            leader_in_map: Pose of the leader.
            follower_in_map: Pose of the follower.

        Returns:
            A goal in the map frame; None if the last one is still valid, or the leader is near and in view.
        """
        before, self._leader_in_map = self._leader_in_map or leader_in_map, leader_in_map
        self._leader_step = before.distance_to(leader_in_map)
        if not self._leader_path or self._leader_path[-1].distance_to(leader_in_map) >= _SPACING:
            self._leader_path.append(leader_in_map)
        self._update_motion_state(follower_in_map.distance_to(leader_in_map))
        if self._is_driving:
            goal = self._goal_behind(leader_in_map, follower_in_map)
        else:
            goal = _facing(follower_in_map, leader_in_map)
            if self._faces_the_same_way(follower_in_map, goal):
                return None
        if self._goal is not None and self._is_close(self._goal, goal):
            return None
        self._goal = goal
        return goal

    def _update_motion_state(self, distance: float) -> None:
        """Start driving beyond gap and slack, stop within the gap."""
        if distance > self._settings.gap + self._settings.slack:
            self._is_driving = True
        elif distance <= self._settings.gap:
            self._is_driving = False

    def _is_close(self, one: Pose2, other: Pose2) -> bool:
        return one.distance_to(other) < self._settings.goal_shift and self._faces_the_same_way(one, other)

    def _faces_the_same_way(self, one: Pose2, other: Pose2) -> bool:
        return abs(wrap(one.yaw - other.yaw)) < self._settings.goal_turn

    def _goal_behind(self, leader_in_map: Pose2, follower_in_map: Pose2) -> Pose2:
        """Behind the leader on its path, or straight towards it if it has not moved or has turned back."""
        gap = self._settings.gap
        place = self._pose_behind(leader_in_map)
        if place is None or place.distance_to(leader_in_map) < 0.5 * gap:
            return _towards_follower(leader_in_map, follower_in_map, gap)
        return place

    def _pose_behind(self, leader_in_map: Pose2) -> Optional[Pose2]:
        """On the leader's path, ``gap`` behind its predicted position, facing it; prunes the path before."""
        gap = self._settings.gap
        prediction = min(_PREDICTION_STEPS * self._leader_step, _MAX_PREDICTION_SHARE * gap)
        left, after = gap - prediction, leader_in_map
        for number in range(len(self._leader_path) - 1, -1, -1):
            here = self._leader_path[number]
            left -= here.distance_to(after)
            after = here
            if left <= 0.0:
                del self._leader_path[:number]
                return _facing(here, leader_in_map)
        return None


def _towards_follower(leader_in_map: Pose2, follower_in_map: Pose2, gap: float) -> Pose2:
    """Between the two robots, ``gap`` from the leader, facing it."""
    bearing = math.atan2(follower_in_map.y - leader_in_map.y, follower_in_map.x - leader_in_map.x)
    there = Pose2(leader_in_map.x + gap * math.cos(bearing), leader_in_map.y + gap * math.sin(bearing))
    return _facing(there, leader_in_map)


def _facing(place: Pose2, other: Pose2) -> Pose2:
    return Pose2(place.x, place.y, math.atan2(other.y - place.y, other.x - place.x))
