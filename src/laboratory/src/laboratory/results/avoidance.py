"""Whether a robot could have avoided a contact: a search over its controls, given true motions."""

from dataclasses import dataclass
from typing import List, NamedTuple, Sequence, Tuple

import numpy as np

from sim_bridge.geometry.shapes import Box, Cylinder
from sim_bridge.scripted_trajectories import ScriptedTrajectory
from sim_bridge.world import World

# Time between two changes of the controls, and between two checks of contact [s].
CONTROL_STEP, CHECK_STEP = 0.2, 0.05
# Distance that counts as contact, as the robot's outline is checked at points [m].
MARGIN = 0.02
# Cells in which one state stands for all: x, y [m], yaw [rad], v [m/s], omega [rad/s].
CELLS = np.array([0.05, 0.05, 0.1, 0.25, 0.5])
# States that are expanded at most in a step.
MAX_STATES = 20000


class RobotLimits(NamedTuple):
    """Limits of speed and acceleration [m/s, rad/s, m/s^2, rad/s^2] and the footprint's half sides [m]."""

    min_v: float
    max_v: float
    max_omega: float
    acceleration: float
    turn_acceleration: float
    half_length: float
    half_width: float


class _Circle(NamedTuple):
    trajectory: ScriptedTrajectory
    radius: float


@dataclass(frozen=True)
class TrueObstacles:
    """Circles that move and boxes that do not.

    Attributes:
        circles: Moving cylinders.
        boxes: (N, 4) of the lowest and the highest x and y of each wall [m].
    """

    circles: Tuple[_Circle, ...]
    boxes: np.ndarray

    @classmethod
    def of_world(cls, world: World) -> "TrueObstacles":
        """Read the bodies of a generated or DynaBARN world: cylinders and axis-aligned boxes."""
        trajectories = {each.link: each for each in world.trajectories}
        circles, boxes = [], []
        for body in world.bodies:
            (collision,) = body.collisions
            x, y = body.pose_in_world[:2, 3]
            if isinstance(collision.shape, Cylinder):
                still = ScriptedTrajectory(body.name, np.array([0.0, 1.0]), np.array([[x, y], [x, y]]))
                circles.append(_Circle(trajectories.get(body.name, still), collision.shape.radius))
            elif isinstance(collision.shape, Box):
                half_x, half_y = 0.5 * np.asarray(collision.shape.size)[:2]
                boxes.append((x - half_x, x + half_x, y - half_y, y + half_y))
        return cls(tuple(circles), np.array(boxes).reshape(-1, 4))


def can_avoid(
    obstacles: TrueObstacles, limits: RobotLimits, state: Sequence[float], start: float, seconds: float
) -> bool:
    """Search for controls without a contact.

    The search expands all combinations of full acceleration, none and full deceleration of both speeds, and
    keeps one state of each cell of the state space, so it may miss an escape of a few centimetres.

    Args:
        obstacles: What the robot may touch.
        limits: Limits of the robot.
        state: x, y, yaw, v, omega of the robot at the start, in the world [m, rad, m/s, rad/s].
        start: Time of this state in the simulation [s].
        seconds: Time for which there must be no contact [s].
    """
    states, checks = np.array([state], dtype=float), round(CONTROL_STEP / CHECK_STEP)
    for step in range(round(seconds / CONTROL_STEP)):
        states, accelerations = _branches(states)
        for check in range(checks):
            stamp = start + step * CONTROL_STEP + (check + 1) * CHECK_STEP
            states = _moved(states, accelerations, limits)
            is_free = ~_touches(states, obstacles, limits, stamp)
            states, accelerations = states[is_free], accelerations[is_free]
        states = _thinned(states)
        if not len(states):
            return False
    return True


def _branches(states: np.ndarray) -> Tuple[np.ndarray, np.ndarray]:
    """Each state with each of nine signs (v, omega) of acceleration."""
    signs = np.array([(a, b) for a in (-1.0, 0.0, 1.0) for b in (-1.0, 0.0, 1.0)])
    return np.repeat(states, len(signs), axis=0), np.tile(signs, (len(states), 1))


def _moved(states: np.ndarray, signs: np.ndarray, limits: RobotLimits) -> np.ndarray:
    x, y, yaw, v, omega = states.T
    v = np.clip(v + signs[:, 0] * limits.acceleration * CHECK_STEP, limits.min_v, limits.max_v)
    omega = omega + signs[:, 1] * limits.turn_acceleration * CHECK_STEP
    omega = np.clip(omega, -limits.max_omega, limits.max_omega)
    middle = yaw + 0.5 * omega * CHECK_STEP
    return np.column_stack(
        (
            x + v * CHECK_STEP * np.cos(middle),
            y + v * CHECK_STEP * np.sin(middle),
            yaw + omega * CHECK_STEP,
            v,
            omega,
        )
    )


def _touches(states: np.ndarray, obstacles: TrueObstacles, limits: RobotLimits, stamp: float) -> np.ndarray:
    """Mask (N,) of the states in contact."""
    x, y, yaw = states[:, :3].T
    c, s = np.cos(yaw), np.sin(yaw)
    touches = np.zeros(len(states), dtype=bool)
    for trajectory, radius in obstacles.circles:
        at_x, at_y = trajectory.at(stamp)
        along, across = (at_x - x) * c + (at_y - y) * s, (at_y - y) * c - (at_x - x) * s
        off_x = np.maximum(np.abs(along) - limits.half_length, 0.0)
        off_y = np.maximum(np.abs(across) - limits.half_width, 0.0)
        touches |= np.hypot(off_x, off_y) < radius + MARGIN
    for low_x, high_x, low_y, high_y in obstacles.boxes:
        reach_x = np.abs(limits.half_length * c) + np.abs(limits.half_width * s) + MARGIN
        reach_y = np.abs(limits.half_length * s) + np.abs(limits.half_width * c) + MARGIN
        touches |= (
            (x > low_x - reach_x) & (x < high_x + reach_x) & (y > low_y - reach_y) & (y < high_y + reach_y)
        )
    return touches


def _thinned(states: np.ndarray) -> np.ndarray:
    """One state of each cell, at most MAX_STATES evenly picked."""
    _, kept = np.unique(np.round(states / CELLS).astype(np.int64), axis=0, return_index=True)
    if len(kept) > MAX_STATES:
        kept = kept[np.linspace(0, len(kept) - 1, MAX_STATES).astype(int)]
    return states[kept]


def state_before(track: np.ndarray, seconds: float) -> Tuple[List[float], float]:
    """Return the robot's state some time before the end of a track.

    Args:
        track: (N, 4) of stamp, x, y, yaw.
        seconds: Time before the end; at most the length of the track [s].

    Returns:
        x, y, yaw, v, omega, and the stamp of this state.
    """
    index = max(int(np.searchsorted(track[:, 0], track[-1, 0] - seconds + 1e-6)) - 1, 1)
    (before, x0, y0, yaw0), (stamp, x, y, yaw) = track[index - 1], track[index]
    dt, turned = stamp - before, np.arctan2(np.sin(yaw - yaw0), np.cos(yaw - yaw0))
    v = ((x - x0) * np.cos(yaw0 + 0.5 * turned) + (y - y0) * np.sin(yaw0 + 0.5 * turned)) / dt
    return [x, y, yaw, v, turned / dt], float(stamp)
