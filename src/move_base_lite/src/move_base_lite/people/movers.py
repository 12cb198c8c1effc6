"""What moves near the robot: beams that end together where it was free, tracked at constant velocity."""

import math
from collections import deque
from dataclasses import replace
from typing import Deque, List, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

from move_base_lite.costmap import Observation
from move_base_lite.people.track import FAST, Track
from move_base_lite.people.views import Thing, View, things_in
from planar import Pose2

# Seconds after which a place is looked at again, and, at the start, in which it cannot be told what moves.
LOOK_BACK, BLIND = 1.0, 0.3
# Share of a thing's beams that must end where it was free before.
SHARE_FREE = 0.5
# Seconds that a track may not be seen where the laser looks, and where it does not: behind something, or
# behind the robot.
GONE, HIDDEN = 0.6, 2.5
# Seconds after which a track that is hidden is no thing that has been there all the time.
OVERLOOKED = 0.3
# Seconds for which what has moved is not taken for an obstacle that stays.
MOVED_LATELY = 4.0
# A thing that is not where it was seen so many seconds ago is watched; see Track.
GLANCE = 0.15
NO_MOVERS = np.empty((0, 5))


class Lookout(NamedTuple):
    """How far, m, it is looked for what moves, and whether all is watched that has just appeared."""

    reach: float = 4.0
    watches_all: bool = False


class Movers:
    """Tracks what a laser sees moving; the frame is odometry's, which is smooth."""

    def __init__(self) -> None:
        self._past: Deque[View] = deque()
        self._tracks: List[Track] = []

    def look(
        self, base_in_odom: Pose2, observation: Observation, lookout: Lookout = Lookout()
    ) -> Observation:
        """Takes in the newest scan, made from there; returns it without what has moved lately."""
        if self._past and observation.stamp < self._past[-1].stamp:
            self._past.clear()
            self._tracks.clear()
        view = View(base_in_odom @ observation.sensor_in_base, observation, lookout.reach)
        things = things_in(view)
        before, shortly = self._view_before(view.stamp), self._view_at(view.stamp - BLIND)
        lately = self._view_at(view.stamp - GLANCE)
        for track in self._tracks:
            track.predict(view.stamp)
        for thing in things:
            has_come = _was_free(thing, before)
            is_watched = lookout.watches_all or bool(self._tracks)
            is_new = has_come or (is_watched and _is_news(thing, view.stamp, lately))
            own = self._track_of(thing, -math.inf if is_new else view.stamp - OVERLOOKED)
            if own is not None:
                own.correct(thing, has_come, has_come or _was_free(thing, shortly))
            elif has_come or (is_new and lookout.watches_all):
                self._tracks.append(Track(thing, view.stamp))
        view.things = things
        self._tracks = [
            track for track in self._tracks if track.may_still_be(view, GONE, HIDDEN) and not track.stands
        ]
        self._past.append(view)
        return replace(observation, ranges=self._lasting(view, observation.ranges))

    def at(self, now: float) -> NDArray[np.float64]:
        """What moves: rows (N, 5) of x, y, its velocity by x and y, and radius; metres, m/s, in odom."""
        moving = [track.ahead(now) for track in self._tracks if track.is_moving]
        return np.array(moving) if moving else NO_MOVERS

    def _lasting(self, view: View, ranges: np.ndarray) -> np.ndarray:
        """The ranges (N,), NaN where a beam ends on what has moved lately."""
        lasting = np.array(ranges)
        for track in self._tracks:
            if view.stamp - track.moved_at <= MOVED_LATELY:
                lasting[view.beams[track.covers(view.points_xy)]] = np.nan
        return lasting

    def _view_before(self, stamp: float) -> Optional[View]:
        """The newest view that is old enough to tell what was free; None if there is none yet."""
        while len(self._past) > 1 and stamp - self._past[1].stamp >= LOOK_BACK:
            self._past.popleft()
        is_there = self._past and stamp - self._past[0].stamp >= BLIND
        return self._past[0] if is_there else None

    def _view_at(self, stamp: float) -> Optional[View]:
        """The newest view that is as old as that."""
        return next((view for view in reversed(self._past) if view.stamp <= stamp), None)

    def _track_of(self, thing: Thing, seen_since: float) -> Optional[Track]:
        """The nearest track that the thing may belong to and that nothing else belongs to."""
        candidates = [track for track in self._tracks if track.may_be(thing, seen_since)]
        return min(candidates, key=lambda track: track.distance_to(thing)) if candidates else None


def _was_free(thing: Thing, before: Optional[View]) -> bool:
    """Whether the thing is where that view saw nothing."""
    return before is not None and before.share_seen_through(thing.points_xy) >= SHARE_FREE


def _is_news(thing: Thing, stamp: float, before: Optional[View]) -> bool:
    """Whether the thing was elsewhere before, or hidden: what stands does not seem to go so far."""
    if before is None:
        return False
    distance = FAST * (stamp - before.stamp)
    return all(math.dist(thing.middle_xy, other.middle_xy) > distance for other in before.things)
