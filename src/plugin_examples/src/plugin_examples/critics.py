"""A dynamic window planner built from critics (Fox, Burgard, Thrun, 1997), structured as dwb_local_planner.

Each critic scores all sampled arcs; the arc with the lowest weighted sum is driven. To add one: a function in
``CRITICS``, and its weight as a parameter of the same name.
"""

from dataclasses import dataclass
from itertools import product
from typing import Callable, Tuple

import numpy as np

from move_base_lite import ControlContext, ControlError, ControllerSettings, Plan, Trajectory
from move_base_lite.costmap import INSCRIBED
from planar import Pose2, Twist2
from planar.config.parameters import POSITIVE, at_least, parameter
from planar.geometry.pose import cos_sin

# Samples of speed and turn rate, and poses of an arc.
SPEEDS, TURNS, STEPS = 5, 15, 8
# Minimum sampled speed [m/s].
MIN_SPEED = 0.05
# Distance of the forward point that path_align scores, and lookahead along the plan of goal_distance [m].
FORWARD_POINT_DISTANCE, LOOKAHEAD = 0.3, 0.8


@dataclass(frozen=True)
class CriticsSettings(ControllerSettings):
    """Simulated time, and a weight for each critic, named as its function."""

    sim_time: float = parameter(1.2, "time that each arc is simulated", "s", POSITIVE, dynamic=5.0)
    obstacles: float = parameter(0.4, "weight of the highest cost on the arc", "", at_least(0.0), dynamic=5.0)
    path_distance: float = parameter(
        1.0, "weight of the end's distance to the plan", "", at_least(0.0), dynamic=5.0
    )
    path_align: float = parameter(
        1.0, "weight of the forward point's distance to the plan", "", at_least(0.0), dynamic=5.0
    )
    goal_distance: float = parameter(
        1.0, "weight of the end's distance to a lookahead point", "", at_least(0.0), dynamic=5.0
    )


@dataclass(frozen=True, eq=False)
class SampledArcs:
    """Arcs of constant velocity.

    Attributes:
        commands: Speed and turn rate (N, 2) of each arc [m/s, rad/s].
        poses: x, y, yaw (N, T, 3) along each arc in the local frame.
    """

    commands: np.ndarray
    poses: np.ndarray


# Returns a score (N,) of each arc, given the robot state, the costmaps and the rest of the plan.
Critic = Callable[[SampledArcs, ControlContext, Plan], np.ndarray]


def obstacles(arcs: SampledArcs, context: ControlContext, _plan: Plan) -> np.ndarray:
    """Return the highest cost (N,) on each arc, 0 to 1; inf in collision."""
    window = context.costmap.window
    cells = np.floor((arcs.poses[..., :2] - (window.origin_x, window.origin_y)) / window.resolution).astype(
        int
    )
    cols, rows = np.clip(cells[..., 0], 0, window.cols - 1), np.clip(cells[..., 1], 0, window.rows - 1)
    highest = context.costmap.costs[rows, cols].max(axis=1).astype(float)
    return np.where(highest < INSCRIBED, highest / INSCRIBED, np.inf)


def path_distance(arcs: SampledArcs, _context: ControlContext, plan: Plan) -> np.ndarray:
    """Return the distance (N,) from each end to the plan [m]."""
    return _distances(arcs.poses[:, -1, :2], plan.path_xy).min(axis=1)


def path_align(arcs: SampledArcs, _context: ControlContext, plan: Plan) -> np.ndarray:
    """Return the distance (N,) from each end's forward point to the plan [m].

    It aligns the robot with the plan.
    """
    return _distances(_forward_points(arcs), plan.path_xy).min(axis=1)


def goal_distance(arcs: SampledArcs, _context: ControlContext, plan: Plan) -> np.ndarray:
    """Return the distance (N,) from each end to a lookahead point of the plan [m]."""
    steps = np.hypot(*np.diff(plan.path_xy, axis=0, prepend=plan.path_xy[:1]).T)
    ahead = plan.path_xy[min(int(np.searchsorted(np.cumsum(steps), LOOKAHEAD)), len(steps) - 1)]
    return _distances(arcs.poses[:, -1, :2], ahead[None, :])[:, 0]


CRITICS: Tuple[Critic, ...] = (obstacles, path_distance, path_align, goal_distance)


class Critics:
    """Local planner that drives the sampled arc with the lowest weighted sum of scores.

    Args:
        settings: Simulated time and weights.
        period: Control period [s].
    """

    Settings = CriticsSettings

    def __init__(self, settings: CriticsSettings, period: float):
        self._settings, self._period = settings, period

    def follow(self, context: ControlContext, plan: Plan, limits: Twist2) -> Trajectory:
        """Return the best arc without a collision.

        Args:
            context: Robot state and costmaps.
            plan: Rest of the global plan.
            limits: Largest speed and turn rate [m/s, rad/s].

        Raises:
            ControlError: Every arc collides.
        """
        arcs = self._arcs(context, limits)
        scores = np.zeros(len(arcs.commands))
        for critic in CRITICS:
            scores += getattr(self._settings, critic.__name__) * critic(arcs, context, plan)
        for best in np.argsort(scores, kind="stable"):
            if not np.isfinite(scores[best]):
                break
            poses = arcs.poses[best]
            if not any(context.costmap.collides(Pose2(*pose)) for pose in poses[1:].tolist()):
                return Trajectory(Twist2(*arcs.commands[best].tolist()), poses, float(scores[best]))
        raise ControlError("every arc leads into an obstacle")

    def _arcs(self, context: ControlContext, limits: Twist2) -> SampledArcs:
        """Arcs of the reachable velocities that move the robot forward."""
        reach = [
            self._settings.reachable(context.twist, Twist2(sign * 100.0, sign * 100.0), limits, self._period)
            for sign in (-1.0, 1.0)
        ]
        slowest = min(max(reach[0].v, MIN_SPEED), reach[1].v)
        speeds = np.linspace(slowest, reach[1].v, SPEEDS)
        turns = np.linspace(reach[0].omega, reach[1].omega, TURNS)
        commands = np.array(list(product(speeds, turns)))
        base = context.base_in_local
        turned = np.outer(commands[:, 1], np.linspace(0.0, self._settings.sim_time, STEPS + 1))
        driven = np.outer(commands[:, 0], np.linspace(0.0, self._settings.sim_time, STEPS + 1))
        chord, heading = driven * np.sinc(turned / (2.0 * np.pi)), base.yaw + 0.5 * turned
        x, y = base.x + chord * np.cos(heading), base.y + chord * np.sin(heading)
        return SampledArcs(commands, np.stack([x, y, base.yaw + turned], axis=-1))


def _forward_points(arcs: SampledArcs) -> np.ndarray:
    ends = arcs.poses[:, -1]
    return ends[:, :2] + FORWARD_POINT_DISTANCE * np.column_stack(cos_sin(ends[:, 2]))


def _distances(points_xy: np.ndarray, path_xy: np.ndarray) -> np.ndarray:
    """Distances (N, M) from each point to each point of the path [m]."""
    return np.hypot(*(points_xy[:, None, :] - path_xy[None, :, :]).transpose(2, 0, 1))
