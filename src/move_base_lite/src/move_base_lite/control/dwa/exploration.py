"""What the dynamic window approach tried in a control period: to choose from, and for people to look at."""

from dataclasses import dataclass

import numpy as np

from move_base_lite.control.dwa.arcs import arc
from move_base_lite.control.dwa.critics import Scene, Ways
from move_base_lite.control.dwa.map_grid import UNREACHABLE
from move_base_lite.control.dwa.settings import DwaSettings
from move_base_lite.control.local_planner import Trajectory
from move_base_lite.costmap import INSCRIBED, CostmapWindow
from move_base_lite.errors import ControlError
from planar import Twist2


@dataclass(frozen=True, eq=False)
class Attempts:
    """An Exploration: velocities (N, 2), their scores (N,), inf if they must not be driven.

    ``ways``: how each was followed; ``scene``: what it was judged by, whose costs go on changing.
    """

    settings: DwaSettings
    ways: Ways
    velocities: np.ndarray
    scores: np.ndarray
    window: CostmapWindow
    scene: Scene

    @property
    def shows_trajectories(self) -> bool:
        return self.settings.publish_traj_pc

    @property
    def shows_costs(self) -> bool:
        return self.settings.publish_cost_grid_pc

    def best(self) -> Trajectory:
        """The cheapest. Raises ControlError if none may be driven."""
        if not np.isfinite(self.scores).any():
            raise ControlError("every velocity within reach leads into an obstacle", self)
        best = int(np.argmin(self.scores))
        v, omega = self.velocities[best]
        command = Twist2(float(v), float(omega))
        return Trajectory(command, self._poses(best), float(self.scores[best]), self)

    def trajectory_points(self) -> np.ndarray:
        """Points (M, 4) of all trajectories that may be driven: x, y, yaw, score."""
        points = [np.empty((0, 4))]
        for i in np.flatnonzero(np.isfinite(self.scores)):
            poses = self._poses(int(i))
            points.append(np.column_stack((poses, np.full(len(poses), self.scores[i]))))
        return np.concatenate(points)

    def cell_costs(self) -> np.ndarray:
        """Cells (M, 6) that can be driven to: x, y, cells to plan and to its end, cost, all three weighed."""
        window, settings, scene = self.window, self.settings, self.scene
        is_reached = np.maximum(scene.from_path, scene.from_goal) < UNREACHABLE
        rows, cols = np.nonzero(is_reached & (scene.costs < INSCRIBED))
        to_path, to_goal = scene.from_path[rows, cols], scene.from_goal[rows, cols]
        cost = scene.costs[rows, cols].astype(float)
        way = settings.path_distance_bias * to_path + settings.goal_distance_bias * to_goal
        total = window.resolution * way + settings.occdist_scale * cost
        x = window.origin_x + (cols + 0.5) * window.resolution
        y = window.origin_y + (rows + 0.5) * window.resolution
        return np.column_stack((x, y, to_path, to_goal, cost, total))

    def _poses(self, number: int) -> np.ndarray:
        v, omega = self.velocities[number]
        ways = self.ways
        return arc(ways.start, v, omega, ways.seconds, ways.granularity, ways.angular_granularity)
