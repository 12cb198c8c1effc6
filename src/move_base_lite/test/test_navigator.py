"""The Navigator on a kinematic robot: it arrives, goes round, gives up with a reason, and obeys at once."""

import math
from dataclasses import replace

import numpy as np
import pytest
import yaml
from robot_in_picture import (
    BODY_RADIUS,
    PERIOD,
    PRESET,
    Robot,
    assert_arrived,
    drive_to_end,
    room,
    two_rooms,
    with_block,
)

from move_base_lite import Navigator, Status, settings_from_parameters
from move_base_lite.costmap import INSCRIBED
from move_base_lite.recovery import MoveSlowSettings, NamedRecovery
from planar import Pose2, Twist2, wrap

LOCAL_PLANNERS = ("dwa_local_planner/DWAPlannerROS", "move_base_lite/MppiPlannerROS")


@pytest.fixture(params=LOCAL_PLANNERS)
def settings(request):
    """The preset, with each local planner in turn; DWA with plans as navfn makes them."""
    parameters = yaml.safe_load(PRESET.read_text())
    parameters["NavfnROS"]["any_angle"] = "Mppi" in request.param
    return settings_from_parameters({**parameters, "base_local_planner": request.param})[0]


@pytest.mark.parametrize("door", [0.6, 0.7, 0.9])
@pytest.mark.parametrize("start", [Pose2(0.6, 0.6, 3.0), Pose2(2.6, 3.5, -1.5)])
def test_the_robot_passes_a_door(settings, door, start):
    grid, goal = two_rooms(door), Pose2(5.4, 3.4, 1.0)
    robot, navigator = Robot(grid, start), Navigator(settings, grid)
    navigator.set_goal(goal)
    decisions = drive_to_end(robot, navigator)
    assert_arrived(robot, decisions, goal)
    assert not any(decision.recovery for decision in decisions)


def test_what_dwa_has_chosen_from_can_be_looked_at():
    parameters = {**yaml.safe_load(PRESET.read_text()), "base_local_planner": LOCAL_PLANNERS[0]}
    grid = two_rooms(0.9)
    robot, navigator = Robot(grid, Pose2(1.0, 2.0)), Navigator(settings_from_parameters(parameters)[0], grid)
    navigator.set_goal(Pose2(5.0, 2.0))
    decision = [robot.tick(navigator) for _ in range(10)][-1]
    points = decision.trajectory_samples.trajectory_points()
    cheapest = points[points[:, 3] == points[:, 3].min()]
    assert np.array_equal(cheapest[:, :3], decision.trajectory)
    x, y, to_path, to_goal, cost, total = decision.trajectory_samples.cell_costs().T
    beside_plan = np.hypot(*(decision.followed_xy[:, None] - np.column_stack((x, y))).T).min(axis=1)
    assert beside_plan[to_path == 0.0].max() < navigator.local_costmap.window.resolution
    assert cost.max() < INSCRIBED
    controller = navigator.settings.controller
    way = controller.path_distance_bias * to_path + controller.goal_distance_bias * to_goal
    assert np.allclose(total, 0.05 * way + controller.occdist_scale * cost)


def test_the_robot_leaves_a_trap_whose_end_is_near_the_goal(settings):
    grid = room(6.0, 5.0)
    for block in ((4.0, 1.0, 4.1, 4.0), (2.0, 1.0, 4.1, 1.1), (2.0, 3.9, 4.1, 4.0)):
        grid = with_block(grid, *block)
    goal = Pose2(5.0, 2.5)
    robot, navigator = Robot(grid, Pose2(3.5, 2.5)), Navigator(settings, grid)
    navigator.set_goal(goal)
    assert_arrived(robot, drive_to_end(robot, navigator), goal)


def test_a_box_that_the_map_does_not_show_is_driven_around(settings):
    grid, goal = room(6.0, 4.0), Pose2(5.4, 2.0)
    robot = Robot(with_block(grid, 2.8, 1.7, 3.2, 2.3), Pose2(0.6, 2.0))
    navigator = Navigator(settings, grid)
    navigator.set_goal(goal)
    decisions = drive_to_end(robot, navigator)
    assert_arrived(robot, decisions, goal)
    assert not any(decision.recovery for decision in decisions)


def test_a_box_in_the_door_stops_the_robot_until_it_is_taken_away(settings):
    grid, goal = two_rooms(0.9), Pose2(5.4, 2.0)
    robot, navigator = Robot(with_block(grid, 2.8, 1.4, 3.0, 2.6), Pose2(0.8, 2.0)), Navigator(settings, grid)
    navigator.set_goal(goal)
    while robot.now < 12.0:
        assert not robot.tick(navigator).status.is_final
    assert robot.pose.x < 2.8
    robot.grid = grid
    assert_arrived(robot, drive_to_end(robot, navigator), goal)


def test_a_goal_that_nothing_leads_to_is_given_up_after_all_recoveries_with_a_reason(settings):
    grid = two_rooms(0.0)
    robot, navigator = Robot(grid, Pose2(1.0, 2.0)), Navigator(settings, grid)
    navigator.set_goal(Pose2(5.0, 2.0))
    decisions = drive_to_end(robot, navigator)
    assert decisions[-1].status is Status.ABORTED
    assert decisions[-1].text == (
        "Failed to find a valid plan. Even after executing recovery behaviors. "
        "[code=NO_PATH: no path leads from the robot at (1.00, 2.00) to the goal at (5.00, 2.00)]"
    )
    recoveries = [decision.recovery for decision in decisions if decision.recovery]
    outcome = decisions[-1].outcome
    assert (outcome.code, outcome.reason, outcome.recoveries) == (50, "NO_PATH", 4)
    assert outcome.distance_to_goal == pytest.approx(4.0, abs=0.1)
    assert outcome.seconds > 20.0
    assert [(recovery.name, recovery.index) for recovery in recoveries] == [
        ("conservative_reset", 0),
        ("rotate_recovery", 1),
        ("aggressive_reset", 2),
        ("rotate_recovery_again", 3),
    ]


def two_doors():
    """Two rooms with doors at both ends of the wall between them; and those with something in each door."""
    grid = with_block(room(6.1, 7.0), 3.0, 0.0, 3.1, 7.0)
    doors = ((3.0, 0.5, 3.1, 1.5), (3.0, 5.5, 3.1, 6.5))
    for door in doors:
        grid = with_block(grid, *door, value=0)
    blocked = grid
    for door in doors:
        blocked = with_block(blocked, *door)
    return grid, blocked


def test_a_goal_behind_doors_that_are_all_blocked_is_given_up_although_clearing_forgets_them(settings):
    grid, blocked = two_doors()
    robot, navigator = Robot(blocked, Pose2(1.0, 3.5)), Navigator(settings, grid)
    navigator.set_goal(Pose2(5.0, 3.5))
    decisions = drive_to_end(robot, navigator, 120.0)
    assert decisions[-1].status is Status.ABORTED
    assert "[code=NO_PATH: no path leads from the robot at " in decisions[-1].text
    assert "to the goal at (5.00, 3.50)]" in decisions[-1].text
    names = [decision.recovery.name for decision in decisions if decision.recovery]
    assert names == [recovery.name for recovery in settings.recoveries]


def test_a_door_that_opens_while_the_robot_looks_for_a_way_is_taken(settings):
    grid, blocked = two_doors()
    goal = Pose2(5.0, 3.5)
    robot, navigator = Robot(blocked, Pose2(1.0, 3.5)), Navigator(settings, grid)
    navigator.set_goal(goal)
    recoveries = 0
    while recoveries < 2:
        recoveries += robot.tick(navigator).recovery is not None
    robot.grid = grid
    assert_arrived(robot, drive_to_end(robot, navigator, 120.0), goal)


@pytest.mark.parametrize(
    "goal, code",
    [(Pose2(3.05, 1.0), "GOAL_BLOCKED"), (Pose2(2.9, 1.0), "GOAL_BLOCKED"), (Pose2(9.0, 1.0), "OUT_OF_MAP")],
)
def test_a_goal_that_can_never_be_stood_on_is_given_up_at_once(settings, goal, code):
    grid = two_rooms(0.9)
    robot, navigator = Robot(grid, Pose2(1.0, 2.0)), Navigator(settings, grid)
    navigator.set_goal(goal)
    decision = robot.tick(navigator)
    assert decision.status is Status.ABORTED
    assert decision.text.startswith("Failed to find a valid plan. Even after executing recovery behaviors. ")
    assert f"[code={code}: the goal at ({goal.x:.2f}, {goal.y:.2f}) is " in decision.text


def test_a_cancelled_robot_is_told_to_stop_in_the_same_tick_whatever_it_is_doing(settings):
    grid = two_rooms(0.0)
    for goal, wanted in [
        (Pose2(2.0, 3.0), Status.CONTROLLING),
        (Pose2(5.0, 2.0), Status.PLANNING),
        (Pose2(5.0, 2.0), Status.CLEARING),
    ]:
        robot, navigator = Robot(grid, Pose2(1.0, 1.0)), Navigator(settings, grid)
        navigator.set_goal(goal)
        decision = robot.tick(navigator)
        while decision.status is not wanted or (wanted is Status.CLEARING and decision.command == Twist2()):
            decision = robot.tick(navigator)
        decision = navigator.cancel(robot.now)
        assert (decision.status, decision.command) == (Status.CANCELLED, Twist2())
        assert robot.tick(navigator).status is Status.IDLE
        assert robot.tick(navigator).command is None


def test_a_robot_that_turns_a_third_faster_than_it_is_told_is_not_spun_up(settings):
    grid, goal = room(6.0, 4.0), Pose2(5.4, 3.0, -2.0)
    robot, navigator = Robot(grid, Pose2(0.6, 1.0, 3.0)), Navigator(settings, grid)
    robot.turns_too_fast_by, robot.turn_acceleration = 4.0 / 3.0, 100.0
    robot.twist = Twist2(0.0, 4.0)
    navigator.set_goal(goal)
    assert_arrived(robot, drive_to_end(robot, navigator), goal)


def test_a_new_goal_is_taken_over_without_stopping(settings):
    grid, goal = room(6.0, 4.0), Pose2(5.4, 3.0)
    robot, navigator = Robot(grid, Pose2(0.6, 2.0)), Navigator(settings, grid)
    navigator.set_goal(Pose2(5.4, 2.0))
    while robot.twist.v < 0.4:
        robot.tick(navigator)
    navigator.set_goal(goal)
    assert robot.tick(navigator).command.v > 0.2
    assert_arrived(robot, drive_to_end(robot, navigator), goal)


def test_a_robot_that_is_carried_away_while_it_turns_at_its_goal_drives_back(settings):
    grid, goal = room(4.0, 4.0), Pose2(2.0, 2.0, 3.0)
    robot, navigator = Robot(grid, Pose2(1.2, 2.0)), Navigator(settings, grid)
    navigator.set_goal(goal)
    while not (robot.pose.distance_to(goal) < 0.1 and robot.twist.omega > 0.2):
        robot.tick(navigator)
    robot.pose = robot.pose @ Pose2(0.0, -0.5)
    assert_arrived(robot, drive_to_end(robot, navigator), goal)


def believing(robot, jump):
    """A robot whose estimate is off by ``jump(robot)`` metres sideways; its odometry is right."""
    true_tick = Navigator.tick

    def tick(navigator):
        decision = true_tick(
            navigator,
            robot.now,
            robot.pose @ Pose2(0.0, jump(robot)),
            robot.ODOM_IN_MAP.inverse() @ robot.pose,
            robot.twist,
            robot.scan(),
        )
        robot.drive(decision.command or Twist2())
        return decision

    robot.tick = tick
    return robot


@pytest.mark.parametrize("offset", [0.25, 0.3, 0.4])
def test_a_robot_that_believes_itself_elsewhere_whenever_it_turns_arrives_all_the_same(settings, offset):
    grid, goal = room(4.0, 4.0), Pose2(2.0, 2.0, 3.0)
    robot, navigator = Robot(grid, Pose2(1.0, 2.0)), Navigator(settings, grid)
    believing(robot, lambda robot: offset if abs(wrap(robot.pose.yaw - goal.yaw)) < 1.0 else 0.0)
    navigator.set_goal(goal)
    assert drive_to_end(robot, navigator)[-1].text == "Goal reached."


def test_an_estimate_that_jumps_to_and_fro_is_no_progress_of_a_robot_that_stands(settings):
    grid = room(6.0, 4.0)
    robot, navigator = Robot(grid, Pose2(1.0, 2.0)), Navigator(settings, grid)
    robot.drive = lambda command: setattr(robot, "now", robot.now + PERIOD)
    believing(robot, lambda robot: 0.7 if robot.now % 10.0 < 5.0 else 0.0)
    navigator.set_goal(Pose2(5.0, 2.0))
    assert drive_to_end(robot, navigator)[-1].outcome.reason == "OSCILLATION"


def test_an_ended_goal_says_so_once_and_leaves_the_robot_alone(settings):
    grid = room(3.0, 3.0)
    robot, navigator = Robot(grid, Pose2(1.5, 1.5)), Navigator(settings, grid)
    navigator.set_goal(Pose2(1.5, 1.5))
    assert drive_to_end(robot, navigator)[-1].status is Status.SUCCEEDED
    decision = robot.tick(navigator)
    assert (decision.status, decision.command, navigator.is_active) == (Status.IDLE, None, False)


def test_without_scans_the_robot_stops_and_after_a_while_gives_up(settings):
    grid = room(6.0, 4.0)
    robot, navigator = Robot(grid, Pose2(0.6, 2.0)), Navigator(settings, grid)
    navigator.set_goal(Pose2(5.4, 2.0))
    while robot.twist.v < 0.4:
        robot.tick(navigator)
    robot.has_laser, lost_at = False, robot.now
    while robot.now < lost_at + 2.0:
        decision = robot.tick(navigator)
    assert decision.command == Twist2()
    assert decision.text.startswith("Sensor data is out of date")
    decision = drive_to_end(robot, navigator)[-1]
    assert decision.status is Status.ABORTED
    assert "[code=SENSOR_STALE: nothing on scan for 1" in decision.text


def test_a_robot_pushed_against_a_wall_gets_away_from_it(settings):
    grid, goal = room(4.0, 4.0), Pose2(3.0, 2.0)
    robot, navigator = Robot(grid, Pose2(0.1 + BODY_RADIUS + 0.01, 2.0, math.pi)), Navigator(settings, grid)
    navigator.set_goal(goal)
    assert_arrived(robot, drive_to_end(robot, navigator), goal)


def test_a_robot_that_does_not_move_is_given_up_with_that_reason(settings):
    grid = room(6.0, 4.0)
    robot, navigator = Robot(grid, Pose2(1.0, 2.0)), Navigator(settings, grid)
    robot.drive = lambda command: setattr(robot, "now", robot.now + PERIOD)
    navigator.set_goal(Pose2(5.0, 2.0))
    decisions = drive_to_end(robot, navigator)
    assert decisions[-1].outcome.reason == "OSCILLATION"
    assert decisions[-1].text.endswith("the robot does not move when commanded]")
    assert sum(decision.recovery is not None for decision in decisions) == 4


def test_after_move_slow_and_clear_the_robot_is_slow_until_it_has_moved_on(settings):
    slow = MoveSlowSettings(limited_trans_speed=0.2, limited_distance=0.5)
    recovery = NamedRecovery("slow", slow)
    navigator = Navigator(replace(settings, recoveries=(recovery,)), room(6.0, 4.0))
    robot = Robot(with_block(room(6.0, 4.0), 1.4, 0.0, 1.5, 4.0), Pose2(0.8, 2.0))
    navigator.set_goal(Pose2(5.4, 2.0))
    while robot.tick(navigator).recovery is None:
        assert robot.now < 30.0
    robot.grid = room(6.0, 4.0)
    since, speeds = robot.pose, []
    while robot.pose.distance_to(since) < 1.5:
        robot.tick(navigator)
        speeds.append((robot.pose.distance_to(since), robot.twist.v))
    assert max(v for moved, v in speeds if moved < 0.45) < 0.21
    assert max(v for moved, v in speeds if moved > 0.8) > 0.4


def test_what_is_left_is_told_all_the_way(settings):
    grid = room(6.0, 4.0)
    robot, navigator = Robot(grid, Pose2(0.6, 2.0)), Navigator(settings, grid)
    navigator.set_goal(Pose2(5.4, 2.0))
    *on_the_way, last = drive_to_end(robot, navigator)
    left = [decision.progress.distance_left for decision in on_the_way[1:]]
    assert left[0] == pytest.approx(4.8, abs=0.2)
    assert left == sorted(left, reverse=True)
    half = len(on_the_way) // 2
    assert on_the_way[half].progress.seconds_left == pytest.approx(half * PERIOD, rel=0.5)
    assert (last.progress, last.outcome.code, last.outcome.reason) == (None, 0, "SUCCESS")


def test_the_same_run_gives_the_same_poses(settings):
    def poses():
        grid = two_rooms(0.9)
        robot, navigator = Robot(grid, Pose2(0.6, 0.6)), Navigator(settings, grid)
        navigator.set_goal(Pose2(5.4, 3.4))
        drive_to_end(robot, navigator)
        return robot.now, robot.pose

    assert poses() == poses()
