"""Registry of the local planners, and the guard that checks custom ones."""

from typing import Callable

import numpy as np

from move_base_lite.control.dwa import DWA, TRAJECTORY
from move_base_lite.control.local_planner import ControlContext, LocalPlanner, Plan, Trajectory
from move_base_lite.control.mppi import MPPI
from move_base_lite.control.settings import ControllerSettings
from move_base_lite.errors import ControlPluginFailed
from move_base_lite.plugin import Registry
from move_base_lite.plugin_guard import PluginGuard
from planar import SettingsError, Twist2
from planar.config.hints import hint_or_choices
from planar.plugins import PluginContract

# Relative tolerance of the speed limits, for rounding.
ROUNDING = 1e-3


class GuardedLocalPlanner:
    """A LocalPlanner that wraps a custom one.

    Args:
        name: Name of the plugin, for messages.
        make: Constructs the wrapped planner.
    """

    def __init__(self, name: str, make: Callable[[], LocalPlanner]):
        self._guard = PluginGuard(name, make, ControlPluginFailed)

    def follow(self, context: ControlContext, plan: Plan, limits: Twist2) -> Trajectory:
        """Call the wrapped planner (see LocalPlanner.follow).

        Raises:
            ControlPluginFailed: The planner raised, took too long, modified its arguments or returned an
                invalid trajectory.
        """
        with self._guard.watch(context.costmap.costs, context.dynamic_obstacles, plan.path_xy) as planner:
            trajectory = planner.follow(context, plan, limits)
            self._check(trajectory, limits)
        return trajectory

    def _check(self, trajectory: Trajectory, limits: Twist2) -> None:
        command = trajectory.command
        self._guard.check_velocity(command)
        if command.v > limits.v * (1.0 + ROUNDING) or abs(command.omega) > limits.omega * (1.0 + ROUNDING):
            raise self._guard.fail(
                f"asked for {command.v:g} m/s, {command.omega:g} rad/s, "
                f"beyond its limits of {limits.v:g} m/s, {limits.omega:g} rad/s"
            )
        poses = np.asarray(trajectory.poses)
        if not (poses.ndim == 2 and poses.shape[1] == 3 and len(poses) and np.isfinite(poses).all()):
            raise self._guard.fail("gave poses that are not finite or not of the shape (N, 3)")


LOCAL_PLANNERS: Registry[LocalPlanner] = Registry(
    TRAJECTORY,
    DWA,
    MPPI,
    contract=PluginContract(
        "local planner", LocalPlanner, ControllerSettings, "move_base_lite.local_planners"
    ),
    guarded=GuardedLocalPlanner,
)


def check_local_planner(name: str) -> None:
    """Check a local planner's name given by a user.

    The parameter ``base_local_planner`` may also have a name of the official stack that is unknown here;
    move_base then uses the first of LOCAL_PLANNERS.

    Args:
        name: Name of the planner.

    Raises:
        SettingsError: There is no local planner of this name.
    """
    if LOCAL_PLANNERS.find(name) is None:
        raise SettingsError(
            f"there is no local planner {name!r}{hint_or_choices(name, LOCAL_PLANNERS.names)}"
        )
