"""What goes its own way, whatever it meets: Gazebo's animated models, DynaBARN's obstacles, a leader."""

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from typing import List, Tuple

import numpy as np

from sim_bridge.errors import WorldError
from sim_bridge.physics.kinematics import KinematicBodies

# Times a second that bodies on a course are put to where they then are.
TRAJECTORY_RATE = 50


@dataclass(frozen=True, eq=False)
class ScriptedTrajectory:
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
        time = stamp % self._end
        starts, legs = self._legs
        start, x, y, v_x, v_y = legs[bisect_right(starts, time) - 1]
        return x + v_x * (time - start), y + v_y * (time - start)

    @cached_property
    def _end(self) -> float:
        return float(self.times[-1])

    @cached_property
    def _legs(self) -> Tuple[List[float], List[List[float]]]:
        """When each begins, and that, where and how fast, as plain numbers, quicker to ask one by one."""
        starts = self.times[:-1, None]
        speeds = np.diff(self.points_xy, axis=0) / np.diff(self.times)[:, None]
        return starts[:, 0].tolist(), np.hstack((starts, self.points_xy[:-1], speeds)).tolist()


class TrajectoryPlayer:
    """All courses of a scene; ``each`` may be changed at any time."""

    def __init__(self, trajectories: Tuple[ScriptedTrajectory, ...]):
        self.trajectories = trajectories

    def update(self, engine: KinematicBodies, step: int, rate: int, stamp: float) -> None:
        """Before the step of physics number ``step``, of ``rate`` a second, which begins at ``stamp``."""
        if self.trajectories and step % max(rate // TRAJECTORY_RATE, 1) == 0:
            # Somebody may have taken one away.
            there = (course for course in self.trajectories if engine.has_link(course.link))
            engine.set_positions((course.link, *course.at(stamp)) for course in there)
