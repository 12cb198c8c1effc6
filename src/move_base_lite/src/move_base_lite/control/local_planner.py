"""The contract of local planners: a velocity that follows the plan without a collision.

Life cycle: a local planner is constructed with its settings and the control period, once per goal and again
whenever its settings change; it may keep state in between, such as a warm start. ``LocalPlanner.follow``
is called once per control period. The Controller handles what is the same for all local planners and does
not ask them then: turning in place towards the plan, stopping and turning at the goal, backing out of a
collision.

To add one: a module with settings (a subclass of ControllerSettings), a class and its Plugin, and a line in
``control/registry.py``. ``test/test_control_contract.py`` checks every member of the registry.
"""

import math
from dataclasses import dataclass
from typing import Any, Optional, Protocol

import numpy as np

from move_base_lite.control.settings import ControllerSettings
from move_base_lite.costmap import LayeredCostmap
from move_base_lite.errors import ControlPluginFailed, NavigationError
from move_base_lite.trajectory_samples import TrajectorySamples
from planar import Pose2, Twist2
from planar.deprecation import deprecated_names, renamed_fields
from planar.extensions import MAX_CALL_SECONDS, ExtensionPoint, InvalidAnswer

# Relative tolerance of the speed limits, for rounding.
ROUNDING = 1e-3


@renamed_fields(movers="dynamic_obstacles", whole="global_costmap")
@dataclass(frozen=True, eq=False)
class ControlContext:
    """The inputs of a local planner: robot state, costmaps and dynamic obstacles.

    Attributes:
        base_in_map: Robot pose in the map frame.
        base_in_local: Robot pose in the frame of ``costmap`` (odom).
        twist: Velocity of the robot [m/s, rad/s].
        costmap: Local costmap; dynamic obstacles are in it where they were last observed.
        dynamic_obstacles: (N, 5) rows of x, y, vx, vy, radius in the local frame [m, m/s]; see
            DynamicObstacleTracker.
        global_costmap: Costmap of the global planner, in the map frame; it also has what no sensor observes
            at present.
    """

    base_in_map: Pose2
    base_in_local: Pose2
    twist: Twist2
    costmap: LayeredCostmap
    dynamic_obstacles: np.ndarray
    global_costmap: LayeredCostmap


@dataclass(frozen=True, eq=False)
class Plan:
    """The part of a global plan that the robot has not driven yet.

    Attributes:
        path_xy: (N, 2), N >= 1 [m], in the local frame, from the robot to the plan's end or to where the plan
            leaves the local costmap.
        distance_left: Path length to the plan's end, including the part outside of the local costmap [m].
    """

    path_xy: np.ndarray
    distance_left: float


@renamed_fields(exploration="trajectory_samples")
@dataclass(frozen=True, eq=False)
class Trajectory:
    """Velocity command for the coming period and predicted trajectory.

    Attributes:
        command: Velocity command [m/s, rad/s].
        poses: (N, 3) of x, y, yaw in the local frame [m, rad]; the first is the robot's pose.
        cost: Cost of the trajectory, finite, in any unit of the planner.
        trajectory_samples: Trajectories from which it was chosen, if the planner can show them.
    """

    command: Twist2
    poses: np.ndarray
    cost: float
    trajectory_samples: Optional[TrajectorySamples] = None


class LocalPlanner(Protocol):
    """Computes velocity commands that follow a plan; constructed as ``make(settings, period)``."""

    def __init__(self, settings: Any, period: float): ...

    def follow(self, context: ControlContext, plan: Plan, limits: Twist2) -> Trajectory:
        """Compute the velocity command for the next period, within the acceleration limits of the settings.

        Must not modify its arguments. The same sequence of calls must give the same results: random numbers
        come from a seed.

        Args:
            context: Robot state, costmaps and dynamic obstacles.
            plan: The part of the global plan that is still to be driven.
            limits: Maximum speeds [m/s, rad/s], both positive; ``min_vel_x`` of the settings limits v too.

        Returns:
            The command and the trajectory that it is predicted to lead along.

        Raises:
            ControlError: No velocity is safe or none makes progress; may carry the trajectory samples.
        """
        ...


def _checked(trajectory: Trajectory, context: ControlContext, plan: Plan, limits: Twist2) -> Trajectory:
    """Refuse an answer that the Controller cannot execute."""
    command = trajectory.command
    if not (math.isfinite(command.v) and math.isfinite(command.omega)):
        raise InvalidAnswer(f"asked for {command.v} m/s, {command.omega} rad/s")
    if command.v > limits.v * (1.0 + ROUNDING) or abs(command.omega) > limits.omega * (1.0 + ROUNDING):
        raise InvalidAnswer(
            f"asked for {command.v:g} m/s, {command.omega:g} rad/s, "
            f"beyond its limits of {limits.v:g} m/s, {limits.omega:g} rad/s"
        )
    poses = np.asarray(trajectory.poses)
    if not (poses.ndim == 2 and poses.shape[1] == 3 and len(poses) and np.isfinite(poses).all()):
        raise InvalidAnswer("gave poses that are not finite or not of the shape (N, 3)")
    return trajectory


CONTRACT: ExtensionPoint[LocalPlanner] = ExtensionPoint(
    "local planner",
    LocalPlanner,
    "move_base_lite.local_planners",
    ControlPluginFailed,
    passes=(NavigationError,),
    answers={"follow": _checked},
    max_seconds=MAX_CALL_SECONDS,
    is_lazy=True,
    settings=ControllerSettings,
    parameter="base_local_planner",
)
__getattr__ = deprecated_names(__name__, {"Situation": "ControlContext", "Exploration": "TrajectorySamples"})
