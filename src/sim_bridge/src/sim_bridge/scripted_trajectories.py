"""What is moved by a script: dynamic obstacles along trajectories, models at given times."""

import math
from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property
from typing import Callable, Iterable, List, Sequence, Tuple

import numpy as np

from planar import Pose2
from sim_bridge.errors import WorldError
from sim_bridge.physics.kinematics import KinematicBodies, Steps

# Rate at which bodies are moved along their trajectories [Hz].
TRAJECTORY_RATE = 50
# Distance from robots within which no model is moved to [m].
MOVE_CLEARANCE = 1.0


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

    def update(self, engine: KinematicBodies, steps: Steps) -> None:
        """Move the bodies, if due.

        Args:
            engine: Holds the bodies.
            steps: Physics steps before which they move.
        """
        if self.trajectories and (due := steps.due(TRAJECTORY_RATE)):
            stamp = float(steps.stamps(due[-1:])[0])
            # Bodies may have been deleted.
            present = (each for each in self.trajectories if engine.has_link(each.link))
            engine.set_positions((each.link, *each.at(stamp)) for each in present)


@dataclass(frozen=True)
class ModelMove:
    """A model that is moved, such as a piece of furniture by a person.

    Attributes:
        stamp: Simulated time [s].
        model: Name of the model.
        pose: Pose in the world afterwards; the height of the model does not change.
    """

    stamp: float
    model: str
    pose: Pose2


class ScheduledMoves:
    """Moves of models at given times; a move waits while a robot is near the new pose.

    Args:
        moves: The moves.
    """

    def __init__(self, moves: Iterable[ModelMove]):
        self._moves: Sequence[ModelMove] = sorted(moves, key=lambda move: move.stamp)
        self._done = 0

    def next_after(self, stamp: float) -> float:
        """Return the simulated time of the next move after ``stamp`` [s]; infinity without one."""
        return next((move.stamp for move in self._moves[self._done :] if move.stamp > stamp), math.inf)

    def is_due(self, stamp: float) -> bool:
        """Return whether a move is due at a simulated time [s]; at time 0 all are still to come."""
        if stamp == 0.0:
            self._done = 0
        return self._done < len(self._moves) and self._moves[self._done].stamp <= stamp

    def update(self, stamp: float, robots_xy: np.ndarray, move_model: Callable[[str, Pose2], object]) -> None:
        """Make the moves that are due.

        Args:
            stamp: Simulated time [s].
            robots_xy: True positions (M, 2) of the robots in the world [m].
            move_model: Called with the name of a model and its new pose in the world.
        """
        while self.is_due(stamp):
            move = self._moves[self._done]
            distances = np.hypot(*(robots_xy - (move.pose.x, move.pose.y)).T)
            if (distances < MOVE_CLEARANCE).any():
                return
            self._done += 1
            move_model(move.model, move.pose)
