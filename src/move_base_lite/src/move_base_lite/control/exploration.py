"""What the dynamic window approach tried in a control period: to choose from, and for people to look at."""

import math
from dataclasses import dataclass

import numpy as np

from move_base_lite.control.arcs import arc
from move_base_lite.control.map_grid import UNREACHABLE
from move_base_lite.control.settings import DwaSettings
from move_base_lite.control.trajectory import Trajectory
from move_base_lite.costmap import INSCRIBED, Window
from move_base_lite.errors import ControlError
from planar import Pose2, Twist2


@dataclass(frozen=True, eq=False)
class Exploration:
    """Velocities (N, 2), their scores (N,), inf if they must not be driven, and what these come from.

    ``start``: where each is followed from, for ``horizon`` seconds. ``costs``: those of the costmap, which
    goes on changing; ``from_path``, ``from_goal``: cells to the plan and to its end. All (rows, cols).
    """

    settings: DwaSettings
    start: Pose2
    horizon: float
    velocities: np.ndarray
    scores: np.ndarray
    window: Window
    costs: np.ndarray
    from_path: np.ndarray
    from_goal: np.ndarray

    def best(self) -> Trajectory:
        """The cheapest. Raises ControlError if none may be driven."""
        best = int(np.argmin(self.scores))
        if not math.isfinite(self.scores[best]):
            raise ControlError("every velocity within reach leads into an obstacle")
        v, omega = self.velocities[best]
        return Trajectory(Twist2(float(v), float(omega)), self._poses(best), float(self.scores[best]))

    def trajectory_points(self) -> np.ndarray:
        """Points (M, 4) of all trajectories that may be driven: x, y, yaw, score."""
        points = [np.empty((0, 4))]
        for i in np.flatnonzero(np.isfinite(self.scores)):
            poses = self._poses(i)
            points.append(np.column_stack((poses, np.full(len(poses), self.scores[i]))))
        return np.concatenate(points)

    def cell_costs(self) -> np.ndarray:
        """Cells (M, 6) that can be driven to: x, y, cells to plan and to its end, cost, all three weighed."""
        window, settings = self.window, self.settings
        is_reached = np.maximum(self.from_path, self.from_goal) < UNREACHABLE
        rows, cols = np.nonzero(is_reached & (self.costs < INSCRIBED))
        to_path, to_goal = self.from_path[rows, cols], self.from_goal[rows, cols]
        cost = self.costs[rows, cols].astype(float)
        way = settings.path_distance_bias * to_path + settings.goal_distance_bias * to_goal
        total = window.resolution * way + settings.occdist_scale * cost
        x = window.origin_x + (cols + 0.5) * window.resolution
        y = window.origin_y + (rows + 0.5) * window.resolution
        return np.column_stack((x, y, to_path, to_goal, cost, total))

    def _poses(self, number: int) -> np.ndarray:
        settings = self.settings
        v, omega = self.velocities[number]
        return arc(
            self.start.as_array(),
            v,
            omega,
            self.horizon,
            settings.sim_granularity,
            settings.angular_sim_granularity,
        )
