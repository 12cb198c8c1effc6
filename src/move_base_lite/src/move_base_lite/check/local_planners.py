"""Contract checks of local planners."""

import math
from dataclasses import replace
from typing import Any

import numpy as np

from move_base_lite.check.maps import PERIOD, PICTURES, check_map, context_of, drive, plan_in
from move_base_lite.control import Plan
from move_base_lite.errors import ControlError, ControlPluginFailed
from planar import Pose2, Twist2
from planar.extensions import Plugin
from planar.extensions.check import expect, expect_error, expect_unchanged, same_results

SPEEDS = Twist2(0.5, 1.0)


def reaches_goals(plugin: Plugin[Any]) -> None:
    """It reaches the goal and stops there without a collision, on every map."""
    for name in PICTURES:
        room = check_map(name)
        poses = drive(plugin, room)
        off = math.dist((poses[-1].x, poses[-1].y), room.goal_xy)
        expect(off <= plugin.settings().xy_goal_tolerance, f"{name}: stands {off:.2f} m from the goal")
        hit = next((pose for pose in poses if room.costmap.collides(pose)), None)
        expect(hit is None, f"{name}: collides at {hit}")


def changes_nothing(plugin: Plugin[Any]) -> None:
    """It does not modify its arguments."""
    room, obstacles = check_map("post"), np.array([[2.0, 1.0, 0.0, 0.3, 0.2]])
    context, path_xy = context_of(room.costmap, Pose2(*room.start_xy, 0.0)), plan_in(room)
    with expect_unchanged(costs=room.costmap.costs, plan=path_xy, dynamic_obstacles=obstacles):
        plugin.make(plugin.settings(), PERIOD).follow(
            replace(context, dynamic_obstacles=obstacles), Plan(path_xy, 4.5), SPEEDS
        )


def stays_within_limits(plugin: Plugin[Any]) -> None:
    """Its commands keep the speed limits and the acceleration limits."""
    room, settings = check_map("corner"), plugin.settings()
    for limits in (SPEEDS, Twist2(0.2, 1.0), Twist2(0.5, 0.1)):
        planner, twist = plugin.make(settings, PERIOD), Twist2()
        pose, path_xy = Pose2(*room.start_xy, -0.5), plan_in(room)
        for _ in range(5):
            context = context_of(room.costmap, pose, twist)
            now = planner.follow(context, Plan(path_xy, 5.0), limits).command
            expect(settings.min_vel_x <= now.v <= limits.v + 1e-9, f"{now.v} m/s, limit {limits.v}")
            expect(abs(now.omega) <= limits.omega + 1e-9, f"{now.omega} rad/s, limit {limits.omega}")
            # A robot at rest may start at min_vel_trans.
            reach = max(settings.acc_lim_x * PERIOD, settings.min_vel_trans)
            expect(abs(now.v - twist.v) <= reach + 1e-9, f"from {twist.v} to {now.v} m/s in {PERIOD} s")
            turn_reach = settings.acc_lim_theta * PERIOD
            is_reachable = abs(now.omega - twist.omega) <= turn_reach + 1e-9
            expect(is_reachable, f"from {twist.omega} to {now.omega} rad/s in {PERIOD} s")
            twist = now


def predicts_its_trajectory(plugin: Plugin[Any]) -> None:
    """A trajectory starts at the robot's pose, is collision-free and has a finite cost."""
    room = check_map("open")
    pose = Pose2(*room.start_xy, 0.2)
    planner = plugin.make(plugin.settings(), PERIOD)
    trajectory = planner.follow(context_of(room.costmap, pose), Plan(plan_in(room), 4.5), SPEEDS)
    poses = np.asarray(trajectory.poses)
    is_shaped = poses.ndim == 2 and poses.shape[1] == 3 and len(poses) > 1
    expect(is_shaped, f"poses of the shape {poses.shape}, not (N, 3) with N > 1")
    expect(np.allclose(poses[0], pose.as_array()), f"begins at {poses[0]}, the robot is at {pose}")
    expect(math.isfinite(trajectory.cost), f"a cost of {trajectory.cost}")
    touches = any(room.costmap.collides(Pose2(*row)) for row in poses.tolist())
    expect(not touches, "collides on an open map")


def refuses_a_blocked_plan(plugin: Plugin[Any]) -> None:
    """It raises a ControlError if the plan is blocked as far as the costmap shows it."""
    room = check_map("open")
    x, y = room.start_xy
    in_the_wall = Plan(np.array([[x - 0.5, y], [x - 0.5, y + 0.3]]), 0.8)
    planner = plugin.make(plugin.settings(), PERIOD)
    with expect_error(ControlError, "drives into the wall"):
        try:
            planner.follow(context_of(room.costmap, Pose2(x, y, math.pi)), in_the_wall, SPEEDS)
        except ControlPluginFailed as failure:
            expect(False, str(failure))


CHECKS = (
    reaches_goals,
    same_results(lambda plugin: drive(plugin, check_map("corner"))),
    changes_nothing,
    stays_within_limits,
    predicts_its_trajectory,
    refuses_a_blocked_plan,
)
