"""What a local planner shows of its search; apart from the planners, as errors carry it too."""

from typing import Protocol

import numpy as np


class TrajectorySamples(Protocol):
    """The trajectories that a local planner evaluated, for display (dwa_local_planner's point clouds).

    Valid until the next control period.
    """

    @property
    def shows_trajectories(self) -> bool:
        """Whether the settings ask for ``trajectory_cloud``."""
        ...

    @property
    def shows_costs(self) -> bool:
        """Whether the settings ask for ``cost_cloud``."""
        ...

    def trajectory_points(self) -> np.ndarray:
        """Compute the points of all valid trajectories.

        Returns:
            (M, 4), rows of x, y, yaw in the local frame, and score.
        """
        ...

    def cell_costs(self) -> np.ndarray:
        """Compute the costs of all reachable cells.

        Returns:
            (M, 6), rows of x, y in the local frame, cells to the plan, cells to its end, cost and weighted
            sum.
        """
        ...
