"""Stands before a local planner of other people: what it gives is checked, what it raises is its fault."""

from typing import Callable

import numpy as np

from move_base_lite.control.local_planner import LocalPlanner, Plan, Situation, Trajectory
from move_base_lite.errors import ControlPluginFailed
from move_base_lite.plugin_guard import PluginGuard
from planar import Twist2

# Of a limit of speed, by which rounding may exceed it.
ROUNDING = 1e-3


class GuardedLocalPlanner:
    """A LocalPlanner; see there."""

    def __init__(self, name: str, make: Callable[[], LocalPlanner]):
        self._guard = PluginGuard(name, make, ControlPluginFailed)

    def follow(self, situation: Situation, plan: Plan, limits: Twist2) -> Trajectory:
        with self._guard.watch(situation.costmap.costs, situation.movers, plan.path_xy) as planner:
            trajectory = planner.follow(situation, plan, limits)
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
