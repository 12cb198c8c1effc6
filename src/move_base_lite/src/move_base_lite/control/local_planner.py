"""The contract of local planners: a velocity that follows the plan without touching anything.

Life cycle. A local planner is made with its settings and the control period, for each goal and whenever its
settings change; it may keep what it has learned in between, as the speeds it had in mind. Once a period it is
asked to :meth:`~LocalPlanner.follow` a plan. It is not asked where all local planners do the same, which is
the Controller's: turning to the plan, standing still at the goal and turning as it says, backing out of a
contact.

To add one: a file with settings (a subclass of ControllerSettings), a class and its Plugin, and a line in
``control/registry.py``. ``test/test_control_contract.py`` holds it to what is said here.
"""

from dataclasses import dataclass
from typing import Any, Optional, Protocol

import numpy as np

from move_base_lite.costmap import LayeredCostmap
from planar import Pose2, Twist2


@dataclass(frozen=True, eq=False)
class Situation:
    """What a velocity is chosen from: where the robot is, how fast, and what is around it.

    ``base_in_local``, ``base_in_map``: the robot in the frame of the ``costmap``, odometry's, and in the map.
    ``twist``: m/s, rad/s. ``movers``: rows (N, 5) of what moves, in the local frame: x, y, velocity by x and
    y, radius (see people.Movers); the costmap shows them where they have been seen. ``whole``: the costmap
    that was planned on, in the map: it also knows what is out of sight.
    """

    base_in_map: Pose2
    base_in_local: Pose2
    twist: Twist2
    costmap: LayeredCostmap
    movers: np.ndarray
    whole: LayeredCostmap


@dataclass(frozen=True, eq=False)
class Plan:
    """What is left of a plan.

    ``path_xy``: (N, 2), at least one point, in the local frame, from the robot on to where it ends or leaves
    the costmap. ``distance_left``: metres to its very end, also behind the costmap's edge.
    """

    path_xy: np.ndarray
    distance_left: float


class Exploration(Protocol):
    """What a velocity was chosen from, for people to look at before the next period, if the settings ask."""

    @property
    def shows_trajectories(self) -> bool: ...

    @property
    def shows_costs(self) -> bool: ...

    def trajectory_points(self) -> np.ndarray:
        """Points (M, 4) of all trajectories that may be driven: x, y, yaw, score; in the local frame."""
        ...

    def cell_costs(self) -> np.ndarray:
        """Cells (M, 6) that can be driven to: x, y, cells to plan and to its end, cost, all three weighed."""
        ...


@dataclass(frozen=True, eq=False)
class Trajectory:
    """The velocity chosen for the coming period, and where it may lead.

    ``poses``: (N, 3), x, y, yaw in the local frame, the first the robot's own. ``cost``: by the planner's own
    measure, finite. ``exploration``: what it was chosen from, if the planner has that to show.
    """

    command: Twist2
    poses: np.ndarray
    cost: float
    exploration: Optional[Exploration] = None


class LocalPlanner(Protocol):
    """Made by ``make(settings, period)``; seconds."""

    def __init__(self, settings: Any, period: float): ...

    def follow(self, situation: Situation, plan: Plan, limits: Twist2) -> Trajectory:
        """The velocity for the next period, within the settings' accelerations, and where it leads.

        ``limits``: the highest speeds, m/s and rad/s, both positive; backwards the settings' own count.
        None of the arguments is changed, and the same calls give the same answers: chance has a seed.
        Raises ControlError if no velocity is safe, or none leads on; what was tried may go with it.
        """
        ...
