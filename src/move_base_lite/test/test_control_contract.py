"""The contract of local planners: what any of them, whoever wrote it, has to do on tiny maps."""

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

from move_base_lite.control import LOCAL_PLANNERS, Controller, Plan, Situation
from move_base_lite.costmap import CostmapSettings, LayeredCostmap
from move_base_lite.costmap.layers.inflation import InflationSettings
from move_base_lite.costmap.layers.static import StaticSettings
from move_base_lite.errors import ControlError
from move_base_lite.people import NO_MOVERS
from move_base_lite.planning import Navfn, NavfnSettings
from planar import Pose2, Twist2, grid_from_picture

PERIOD = 0.1
RADIUS = 0.2
# Metres across a character of a picture, in which the robot drives from S to G.
CELL = 0.5
PICTURES = {
    "open": """
############
#..........#
#S........G#
#..........#
############""",
    "corner": """
#########
#S......#
#.......#
#####...#
#####...#
#####.G.#
#########""",
    "door": """
############
#....#.....#
#....#.....#
#S........G#
#....#.....#
#....#.....#
############""",
    "post": """
############
#..........#
#..........#
#S...#....G#
#..........#
#..........#
############""",
}
ANYWHERE = Twist2(math.inf, math.inf)


@dataclass(frozen=True)
class Room:
    """A costmap with a start and a goal."""

    costmap: LayeredCostmap
    start_xy: tuple
    goal_xy: tuple


def room_of(picture):
    """The picture in cells of 0.05 m."""
    lines = picture.strip().splitlines()
    marks = {}
    for number, line in enumerate(reversed(lines)):
        for mark in "SG":
            if mark in line:
                marks[mark] = ((line.index(mark) + 0.5) * CELL, (number + 0.5) * CELL)
    times = round(CELL / 0.05)
    coarse = grid_from_picture(picture.strip().replace("S", ".").replace("G", "."), CELL)
    grid = replace(coarse, cells=np.kron(coarse.cells, np.ones((times, times), np.int8)), resolution=0.05)
    settings = CostmapSettings(
        static=StaticSettings(),
        robot_radius=RADIUS,
        inflation=InflationSettings(inflation_radius=0.5, cost_scaling_factor=5.0),
    )
    return Room(LayeredCostmap(settings, grid), marks["S"], marks["G"])


@pytest.fixture(params=LOCAL_PLANNERS.members, ids=lambda member: member.short_name)
def member(request):
    return request.param


def situation_of(costmap, pose, twist=Twist2()):
    return Situation(pose, pose, twist, costmap, NO_MOVERS)


def plan_in(room):
    costs, window = room.costmap.costs, room.costmap.window
    return Navfn(NavfnSettings()).plan(costs, window, room.start_xy, room.goal_xy)


def drive(member, room, seconds=40.0):
    """The poses of a robot that does at once what it is told, until it stands at the goal."""
    settings = member.settings()
    controller = Controller(settings, PERIOD, member.make(settings, PERIOD))
    controller.set_plan(plan_in(room), Pose2(*room.goal_xy, 0.0))
    pose, twist, poses = Pose2(*room.start_xy, 0.0), Twist2(), []
    for _ in range(round(seconds / PERIOD)):
        poses.append(pose)
        if controller.is_goal_reached(pose, twist):
            return poses
        twist = controller.control(situation_of(room.costmap, pose, twist), ANYWHERE).command
        turned = twist.omega * PERIOD
        pose = pose @ Pose2(
            twist.v * PERIOD * math.cos(turned / 2), twist.v * PERIOD * math.sin(turned / 2), turned
        )
    raise AssertionError(f"not there after {seconds} s: {pose}")


@pytest.mark.parametrize("picture", PICTURES)
def test_it_reaches_the_goal_and_stops_there_without_a_collision(member, picture):
    room = room_of(PICTURES[picture])
    poses = drive(member, room)
    assert math.dist((poses[-1].x, poses[-1].y), room.goal_xy) <= member.settings().xy_goal_tolerance
    assert not any(room.costmap.collides(pose) for pose in poses)


def test_the_same_calls_give_the_same_answers(member):
    assert drive(member, room_of(PICTURES["corner"])) == drive(member, room_of(PICTURES["corner"]))


def test_what_it_is_given_stays_as_it_was(member):
    room = room_of(PICTURES["post"])
    path_xy = plan_in(room)
    movers = np.array([[2.0, 1.0, 0.0, 0.3, 0.2]])
    before = room.costmap.costs.copy(), path_xy.copy(), movers.copy()
    situation = replace(situation_of(room.costmap, Pose2(*room.start_xy, 0.0)), movers=movers)
    member.make(member.settings(), PERIOD).follow(situation, Plan(path_xy, 4.5), Twist2(0.5, 1.0))
    for was, is_now in zip(before, (room.costmap.costs, path_xy, movers)):
        np.testing.assert_array_equal(was, is_now)


@pytest.mark.parametrize("limits", [Twist2(0.5, 1.0), Twist2(0.2, 1.0), Twist2(0.5, 0.1)])
def test_its_velocity_is_within_the_limits_and_within_reach(member, limits):
    room, settings = room_of(PICTURES["corner"]), member.settings()
    planner, twist = member.make(settings, PERIOD), Twist2()
    pose, path_xy = Pose2(*room.start_xy, -0.5), plan_in(room)
    for _ in range(5):
        trajectory = planner.follow(situation_of(room.costmap, pose, twist), Plan(path_xy, 5.0), limits)
        command = trajectory.command
        assert settings.min_vel_x <= command.v <= limits.v + 1e-9
        assert abs(command.omega) <= limits.omega + 1e-9
        # A robot at rest may set off at once with the least speed that moves it.
        reach = max(settings.acc_lim_x * PERIOD, settings.min_vel_trans)
        assert abs(command.v - twist.v) <= reach + 1e-9
        assert abs(command.omega - twist.omega) <= settings.acc_lim_theta * PERIOD + 1e-9
        twist = command


def test_a_trajectory_begins_where_the_robot_is_and_costs_something_finite(member):
    room = room_of(PICTURES["open"])
    pose = Pose2(*room.start_xy, 0.2)
    planner = member.make(member.settings(), PERIOD)
    trajectory = planner.follow(situation_of(room.costmap, pose), Plan(plan_in(room), 4.5), Twist2(0.5, 1.0))
    assert trajectory.poses.shape[1] == 3 and len(trajectory.poses) > 1
    np.testing.assert_allclose(trajectory.poses[0], pose.as_array())
    assert math.isfinite(trajectory.cost)
    assert not any(room.costmap.collides(Pose2(*way)) for way in trajectory.poses.tolist())


def test_a_plan_that_is_blocked_as_far_as_it_is_seen_is_refused(member):
    room = room_of(PICTURES["open"])
    x, y = room.start_xy
    in_the_wall = Plan(np.array([[x - 0.5, y], [x - 0.5, y + 0.3]]), 0.8)
    planner = member.make(member.settings(), PERIOD)
    with pytest.raises(ControlError):
        planner.follow(situation_of(room.costmap, Pose2(x, y, math.pi)), in_the_wall, Twist2(0.5, 1.0))
