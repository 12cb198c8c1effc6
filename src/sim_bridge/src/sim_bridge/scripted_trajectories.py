"""Scripted trajectories of dynamic obstacles: SDF actors, DynaBARN's cylinders, a leader to follow."""

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from typing import List, Tuple

import numpy as np

from sim_bridge.errors import WorldError
from sim_bridge.physics.kinematics import KinematicBodies

# Rate at which bodies are moved along their trajectories [Hz].
TRAJECTORY_RATE = 50


@dataclass(frozen=True, eq=False)
class ScriptedTrajectory:
    """A closed-loop trajectory of a kinematic body: piecewise linear, repeated after its last time.

    Attributes:
        link: Name of the body, ``model::link``.
        times: Increasing times (N,) from 0 [s].
        points_xy: Positions (N, 2) in the world at these times [m].

    Raises:
        WorldError: The times do not increase from 0, or there is not one finite point for each.
    """

    link: str
    times: np.ndarray
    points_xy: np.ndarray

    def __post_init__(self):
        is_increasing = (
            len(self.times) > 1 and self.times[0] == 0.0 and bool((np.diff(self.times) > 0.0).all())
        )
        if not (
            is_increasing
            and self.points_xy.shape == (len(self.times), 2)
            and np.isfinite(self.points_xy).all()
        ):
            raise WorldError(
                f"{self.link}: a trajectory needs increasing times from 0 and a finite point for each"
            )

    def at(self, stamp: float) -> Tuple[float, float]:
        """Return the position, x and y in the world [m], at a simulated time [s]."""
        time = stamp % self._end
        starts, segments = self._segments
        start, x, y, v_x, v_y = segments[bisect_right(starts, time) - 1]
        return x + v_x * (time - start), y + v_y * (time - start)

    @cached_property
    def _end(self) -> float:
        return float(self.times[-1])

    @cached_property
    def _segments(self) -> Tuple[List[float], List[List[float]]]:
        """Start times of the segments, and start time, position and velocity of each, as plain floats."""
        starts = self.times[:-1, None]
        speeds = np.diff(self.points_xy, axis=0) / np.diff(self.times)[:, None]
        return starts[:, 0].tolist(), np.hstack((starts, self.points_xy[:-1], speeds)).tolist()


class TrajectoryPlayer:
    """Moves the bodies of a scene along their trajectories.

    Attributes:
        trajectories: The trajectories; may be replaced at any time.
    """

    def __init__(self, trajectories: Tuple[ScriptedTrajectory, ...]):
        self.trajectories = trajectories

    def update(self, engine: KinematicBodies, step: int, rate: int, stamp: float) -> None:
        """Move the bodies, if due.

        Args:
            engine: Holds the bodies.
            step: Number of the next physics step.
            rate: Physics steps per second.
            stamp: Simulated time [s].
        """
        if self.trajectories and step % max(rate // TRAJECTORY_RATE, 1) == 0:
            # Bodies may have been deleted.
            present = (each for each in self.trajectories if engine.has_link(each.link))
            engine.set_positions((each.link, *each.at(stamp)) for each in present)
