"""What goes its own way, whatever it meets: Gazebo's animated models, DynaBARN's obstacles, a leader."""

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from typing import List, Protocol, Tuple

import numpy as np

from sim_bridge.errors import WorldError

# Times a second that bodies on a course are put to where they then are.
COURSE_RATE = 50


@dataclass(frozen=True, eq=False)
class Course:
    """The way of the body ``link``: at ``times`` (N,), s, from 0, it is at ``points_xy`` (N, 2), then anew.

    In between it goes straight. Raises WorldError if that is no way.
    """

    link: str
    times: np.ndarray
    points_xy: np.ndarray

    def __post_init__(self):
        rises = len(self.times) > 1 and self.times[0] == 0.0 and bool((np.diff(self.times) > 0.0).all())
        if not (rises and self.points_xy.shape == (len(self.times), 2) and np.isfinite(self.points_xy).all()):
            raise WorldError(f"{self.link}: a course needs times that rise from 0, and a place for each")

    def at(self, stamp: float) -> Tuple[float, float]:
        """Where the body is, x and y in the world."""
        time = stamp % float(self.times[-1])
        times, points = self._keyframes
        after = bisect_right(times, time)
        (x1, y1), (x2, y2) = points[after - 1 : after + 1]
        share = (time - times[after - 1]) / (times[after] - times[after - 1])
        return x1 + share * (x2 - x1), y1 + share * (y2 - y1)

    @cached_property
    def _keyframes(self) -> Tuple[List[float], List[List[float]]]:
        """As plain numbers, which are quicker to ask one by one."""
        return self.times.tolist(), self.points_xy.tolist()


class Movable(Protocol):
    """What holds the bodies: the engine."""

    def shift(self, name: str, x: float, y: float) -> None:
        """Puts a body to another place."""


class Courses:
    """All courses of a scene; ``each`` may be changed at any time."""

    def __init__(self, each: Tuple[Course, ...]):
        self.each = each

    def follow(self, engine: Movable, step: int, rate: int, stamp: float) -> None:
        """Before the step of physics number ``step``, of ``rate`` a second, which begins at ``stamp``."""
        if self.each and step % max(rate // COURSE_RATE, 1) == 0:
            for course in self.each:
                engine.shift(course.link, *course.at(stamp))
