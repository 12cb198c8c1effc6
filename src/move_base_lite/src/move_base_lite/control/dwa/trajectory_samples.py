"""The trajectories that the dynamic window approach evaluated in a control period."""

from dataclasses import dataclass

import numpy as np

from move_base_lite.control.dwa.arcs import arc
from move_base_lite.control.dwa.critics import ArcSampling, DwaScene
from move_base_lite.control.dwa.map_grid import UNREACHABLE
from move_base_lite.control.dwa.settings import DwaSettings
from move_base_lite.control.local_planner import Trajectory
from move_base_lite.costmap import INSCRIBED, CostmapWindow
from move_base_lite.errors import ControlError
from planar import Twist2


@dataclass(frozen=True, eq=False)
class DwaTrajectorySamples:
    """TrajectorySamples of DWA.

    Attributes:
        settings: The planner's settings.
        sampling: How each velocity was simulated.
        velocities: (N, 2) of v, omega [m/s, rad/s].
        scores: (N,), inf for an invalid trajectory.
        window: CostmapWindow of the local costmap.
        scene: The grids that the trajectories were scored on; its costs change with the costmap.
    """

    settings: DwaSettings
    sampling: ArcSampling
    velocities: np.ndarray
    scores: np.ndarray
    window: CostmapWindow
    scene: DwaScene

    @property
    def shows_trajectories(self) -> bool:
        return self.settings.publish_traj_pc

    @property
    def shows_costs(self) -> bool:
        return self.settings.publish_cost_grid_pc

    def best(self) -> Trajectory:
        """Return the trajectory with the lowest score.

        Raises:
            ControlError: No trajectory is valid.
        """
        if not np.isfinite(self.scores).any():
            raise ControlError("every velocity within reach leads into an obstacle", self)
        best = int(np.argmin(self.scores))
        v, omega = self.velocities[best]
        command = Twist2(float(v), float(omega))
        return Trajectory(command, self._poses(best), float(self.scores[best]), self)

    def trajectory_points(self) -> np.ndarray:
        """Compute the points of all valid trajectories.

        Returns:
            (M, 4), rows of x, y, yaw in the local frame, and score.
        """
        points = [np.empty((0, 4))]
        for i in np.flatnonzero(np.isfinite(self.scores)):
            poses = self._poses(int(i))
            points.append(np.column_stack((poses, np.full(len(poses), self.scores[i]))))
        return np.concatenate(points)

    def cell_costs(self) -> np.ndarray:
        """Compute the costs of all reachable cells.

        Returns:
            (M, 6), rows of x, y in the local frame, cells to the plan, cells to its end, cost and weighted
            sum.
        """
        window, settings, scene = self.window, self.settings, self.scene
        is_reached = np.maximum(scene.path_map, scene.goal_map) < UNREACHABLE
        rows, cols = np.nonzero(is_reached & (scene.costs < INSCRIBED))
        to_path, to_goal = scene.path_map[rows, cols], scene.goal_map[rows, cols]
        cost = scene.costs[rows, cols].astype(float)
        distance = settings.path_distance_bias * to_path + settings.goal_distance_bias * to_goal
        total = window.resolution * distance + settings.occdist_scale * cost
        x = window.origin_x + (cols + 0.5) * window.resolution
        y = window.origin_y + (rows + 0.5) * window.resolution
        return np.column_stack((x, y, to_path, to_goal, cost, total))

    def _poses(self, index: int) -> np.ndarray:
        v, omega = self.velocities[index]
        sampling = self.sampling
        return arc(
            sampling.start, v, omega, sampling.seconds, sampling.granularity, sampling.angular_granularity
        )
