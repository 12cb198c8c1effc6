"""The facade: where to go in order to follow a robot."""

import math
from typing import List, Optional

from follow_me.config import FollowSettings
from planar import Pose2, wrap

# Points of the leader's way are this far from each other, metres.
_SPACING = 0.05
# The leader is expected to go on as since the last call for so many more, by this share of the gap at most.
_AHEAD, _MOST_AHEAD = 2.0, 0.3


class Follower:
    """Goes where the leader has been, so that the way is free, and stays ``gap`` behind it along that way.

    Once there it stands and turns with the leader, so as to be able to set off at once when that goes on.
    """

    def __init__(self, settings: FollowSettings):
        self._settings = settings
        self._way: List[Pose2] = []
        self._goal: Optional[Pose2] = None
        self._leader_in_map: Optional[Pose2] = None
        self._leader_step = 0.0
        self._is_under_way = False

    def goal(self, leader_in_map: Pose2, follower_in_map: Pose2) -> Optional[Pose2]:
        """A new pose to go to; None while the last one will do, or the leader is near and in view."""
        before, self._leader_in_map = self._leader_in_map or leader_in_map, leader_in_map
        self._leader_step = before.distance_to(leader_in_map)
        if not self._way or self._way[-1].distance_to(leader_in_map) >= _SPACING:
            self._way.append(leader_in_map)
        self._set_off_or_stop(follower_in_map.distance_to(leader_in_map))
        if self._is_under_way:
            goal = self._goal_behind(leader_in_map, follower_in_map)
        else:
            goal = _facing(follower_in_map, leader_in_map)
            if self._is_turned(follower_in_map, goal):
                return None
        if self._goal is not None and self._is_as_good(self._goal, goal):
            return None
        self._goal = goal
        return goal

    def _set_off_or_stop(self, distance: float) -> None:
        if distance > self._settings.gap + self._settings.slack:
            self._is_under_way = True
        elif distance <= self._settings.gap:
            self._is_under_way = False

    def _is_as_good(self, one: Pose2, other: Pose2) -> bool:
        return one.distance_to(other) < self._settings.goal_shift and self._is_turned(one, other)

    def _is_turned(self, one: Pose2, other: Pose2) -> bool:
        return abs(wrap(one.yaw - other.yaw)) < self._settings.goal_turn

    def _goal_behind(self, leader_in_map: Pose2, follower_in_map: Pose2) -> Pose2:
        """Behind the leader on its way, or straight towards it when it has stood still or turned round."""
        gap = self._settings.gap
        place = self._place_behind(leader_in_map)
        if place is None or place.distance_to(leader_in_map) < 0.5 * gap:
            return _on_the_line(leader_in_map, follower_in_map, gap)
        return place

    def _place_behind(self, leader_in_map: Pose2) -> Optional[Pose2]:
        """On the leader's way, ``gap`` behind where it is soon, looking at it; forgets what lies before."""
        gap = self._settings.gap
        left, after = gap - min(_AHEAD * self._leader_step, _MOST_AHEAD * gap), leader_in_map
        for number in range(len(self._way) - 1, -1, -1):
            here = self._way[number]
            left -= here.distance_to(after)
            after = here
            if left <= 0.0:
                del self._way[:number]
                return _facing(here, leader_in_map)
        return None


def _on_the_line(leader_in_map: Pose2, follower_in_map: Pose2, gap: float) -> Pose2:
    """Between the two, ``gap`` from the leader."""
    bearing = math.atan2(follower_in_map.y - leader_in_map.y, follower_in_map.x - leader_in_map.x)
    there = Pose2(leader_in_map.x + gap * math.cos(bearing), leader_in_map.y + gap * math.sin(bearing))
    return _facing(there, leader_in_map)


def _facing(place: Pose2, other: Pose2) -> Pose2:
    return Pose2(place.x, place.y, math.atan2(other.y - place.y, other.x - place.x))
