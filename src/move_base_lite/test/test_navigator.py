"""The Navigator on a kinematic robot: it reaches goals, avoids obstacles, aborts and cancels."""

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

from move_base_lite import Navigator, NavigatorInputs, RobotState, Status, settings_from_parameters
from move_base_lite.costmap import INSCRIBED, observation_from_scan
from move_base_lite.recovery import MoveSlowSettings, NamedRecovery
from planar import Pose2, Twist2, wrap

LOCAL_PLANNERS = ("dwa_local_planner/DWAPlannerROS", "move_base_lite/MppiPlannerROS")


@pytest.fixture(params=LOCAL_PLANNERS)
def settings(request):
    """The preset with each local planner; DWA with navfn's plans."""
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


def test_dwa_reports_the_samples_it_evaluated():
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
    distance_cost = controller.path_distance_bias * to_path + controller.goal_distance_bias * to_goal
    assert np.allclose(total, 0.05 * distance_cost + controller.occdist_scale * cost)


def test_each_plan_begins_at_the_robot(settings):
    grid = two_rooms(0.9)
    robot, navigator = Robot(grid, Pose2(1.0, 2.0)), Navigator(settings, grid)
    navigator.set_goal(Pose2(5.0, 2.0))
    starts, status = [], Status.WAITING
    while not status.is_final:
        pose, decision = robot.pose, robot.tick(navigator)
        if decision.plan_xy is not None:
            starts.append(math.dist(decision.plan_xy[0], (pose.x, pose.y)))
        status = decision.status
    assert len(starts) > 5
    assert max(starts) < 0.1


def test_the_robot_leaves_a_trap_whose_end_is_near_the_goal(settings):
    grid = room(6.0, 5.0)
    for block in ((4.0, 1.0, 4.1, 4.0), (2.0, 1.0, 4.1, 1.1), (2.0, 3.9, 4.1, 4.0)):
        grid = with_block(grid, *block)
    goal = Pose2(5.0, 2.5)
    robot, navigator = Robot(grid, Pose2(3.5, 2.5)), Navigator(settings, grid)
    navigator.set_goal(goal)
    assert_arrived(robot, drive_to_end(robot, navigator), goal)


def test_the_robot_avoids_a_box_that_is_not_in_the_map(settings):
    grid, goal = room(6.0, 4.0), Pose2(5.4, 2.0)
    robot = Robot(with_block(grid, 2.8, 1.7, 3.2, 2.3), Pose2(0.6, 2.0))
    navigator = Navigator(settings, grid)
    navigator.set_goal(goal)
    decisions = drive_to_end(robot, navigator)
    assert_arrived(robot, decisions, goal)
    assert not any(decision.recovery for decision in decisions)


def test_a_box_in_the_door_stops_the_robot_until_it_is_removed(settings):
    grid, goal = two_rooms(0.9), Pose2(5.4, 2.0)
    robot, navigator = Robot(with_block(grid, 2.8, 1.4, 3.0, 2.6), Pose2(0.8, 2.0)), Navigator(settings, grid)
    navigator.set_goal(goal)
    while robot.now < 12.0:
        assert not robot.tick(navigator).status.is_final
    assert robot.pose.x < 2.8
    robot.grid = grid
    assert_arrived(robot, drive_to_end(robot, navigator), goal)


def test_an_unreachable_goal_is_aborted_after_all_recovery_behaviours_with_a_reason(settings):
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
    """Two rooms connected by two doors, and the same with both doors blocked."""
    grid = with_block(room(6.1, 7.0), 3.0, 0.0, 3.1, 7.0)
    doors = ((3.0, 0.5, 3.1, 1.5), (3.0, 5.5, 3.1, 6.5))
    for door in doors:
        grid = with_block(grid, *door, value=0)
    blocked = grid
    for door in doors:
        blocked = with_block(blocked, *door)
    return grid, blocked


def test_a_goal_behind_blocked_doors_is_aborted_although_clearing_removes_them_from_the_costmap(settings):
    grid, blocked = two_doors()
    robot, navigator = Robot(blocked, Pose2(1.0, 3.5)), Navigator(settings, grid)
    navigator.set_goal(Pose2(5.0, 3.5))
    decisions = drive_to_end(robot, navigator, 120.0)
    assert decisions[-1].status is Status.ABORTED
    assert "[code=NO_PATH: no path leads from the robot at " in decisions[-1].text
    assert "to the goal at (5.00, 3.50)]" in decisions[-1].text
    names = [decision.recovery.name for decision in decisions if decision.recovery]
    assert names == [recovery.name for recovery in settings.recoveries]


def test_a_door_that_opens_during_recovery_is_used(settings):
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
def test_a_goal_that_can_never_be_reached_is_aborted_at_once(settings, goal, code):
    grid = two_rooms(0.9)
    robot, navigator = Robot(grid, Pose2(1.0, 2.0)), Navigator(settings, grid)
    navigator.set_goal(goal)
    decision = robot.tick(navigator)
    assert decision.status is Status.ABORTED
    assert decision.text.startswith("Failed to find a valid plan. Even after executing recovery behaviors. ")
    assert f"[code={code}: the goal at ({goal.x:.2f}, {goal.y:.2f}) is " in decision.text


def test_a_cancelled_goal_stops_the_robot_in_the_same_tick_in_every_state(settings):
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


def test_a_robot_that_turns_a_third_faster_than_commanded_does_not_spin_up(settings):
    grid, goal = room(6.0, 4.0), Pose2(5.4, 3.0, -2.0)
    robot, navigator = Robot(grid, Pose2(0.6, 1.0, 3.0)), Navigator(settings, grid)
    robot.turns_too_fast_by, robot.turn_acceleration = 4.0 / 3.0, 100.0
    robot.twist = Twist2(0.0, 4.0)
    navigator.set_goal(goal)
    assert_arrived(robot, drive_to_end(robot, navigator), goal)


def test_a_new_goal_preempts_the_old_one_without_stopping(settings):
    grid, goal = room(6.0, 4.0), Pose2(5.4, 3.0)
    robot, navigator = Robot(grid, Pose2(0.6, 2.0)), Navigator(settings, grid)
    navigator.set_goal(Pose2(5.4, 2.0))
    while robot.twist.v < 0.4:
        robot.tick(navigator)
    navigator.set_goal(goal)
    assert robot.tick(navigator).command.v > 0.2
    assert_arrived(robot, drive_to_end(robot, navigator), goal)


def test_a_robot_that_is_displaced_while_it_turns_at_its_goal_drives_back(settings):
    grid, goal = room(4.0, 4.0), Pose2(2.0, 2.0, 3.0)
    robot, navigator = Robot(grid, Pose2(1.2, 2.0)), Navigator(settings, grid)
    navigator.set_goal(goal)
    while not (robot.pose.distance_to(goal) < 0.1 and robot.twist.omega > 0.2):
        robot.tick(navigator)
    robot.pose = robot.pose @ Pose2(0.0, -0.5)
    assert_arrived(robot, drive_to_end(robot, navigator), goal)


def with_estimate_error(robot, jump):
    """A robot whose localization is off by ``jump(robot)`` metres sideways; its odometry is correct."""
    true_tick = Navigator.tick

    def tick(navigator):
        base_in_odom = robot.ODOM_IN_MAP.inverse() @ robot.pose
        state = RobotState(robot.now, robot.pose @ Pose2(0.0, jump(robot)), base_in_odom, robot.twist)
        observation = observation_from_scan(navigator.settings.scan_topic, robot.scan())
        decision = true_tick(navigator, state, NavigatorInputs([observation]))
        robot.drive(decision.command or Twist2())
        return decision

    robot.tick = tick
    return robot


@pytest.mark.parametrize("offset", [0.25, 0.3, 0.4])
def test_a_goal_is_reached_although_localization_jumps_whenever_the_robot_turns(settings, offset):
    grid, goal = room(4.0, 4.0), Pose2(2.0, 2.0, 3.0)
    robot, navigator = Robot(grid, Pose2(1.0, 2.0)), Navigator(settings, grid)
    with_estimate_error(robot, lambda robot: offset if abs(wrap(robot.pose.yaw - goal.yaw)) < 1.0 else 0.0)
    navigator.set_goal(goal)
    assert drive_to_end(robot, navigator)[-1].text == "Goal reached."


def test_jumps_of_localization_do_not_count_as_progress_of_a_robot_that_stands(settings):
    grid = room(6.0, 4.0)
    robot, navigator = Robot(grid, Pose2(1.0, 2.0)), Navigator(settings, grid)
    robot.drive = lambda command: setattr(robot, "now", robot.now + PERIOD)
    with_estimate_error(robot, lambda robot: 0.7 if robot.now % 10.0 < 5.0 else 0.0)
    navigator.set_goal(Pose2(5.0, 2.0))
    assert drive_to_end(robot, navigator)[-1].outcome.reason == "OSCILLATION"


def test_the_end_of_a_goal_is_reported_once(settings):
    grid = room(3.0, 3.0)
    robot, navigator = Robot(grid, Pose2(1.5, 1.5)), Navigator(settings, grid)
    navigator.set_goal(Pose2(1.5, 1.5))
    assert drive_to_end(robot, navigator)[-1].status is Status.SUCCEEDED
    decision = robot.tick(navigator)
    assert (decision.status, decision.command, navigator.is_active) == (Status.IDLE, None, False)


def test_without_scans_the_robot_stops_and_the_goal_is_aborted_later(settings):
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


def test_a_robot_in_contact_with_a_wall_drives_away_from_it(settings):
    grid, goal = room(4.0, 4.0), Pose2(3.0, 2.0)
    robot, navigator = Robot(grid, Pose2(0.1 + BODY_RADIUS + 0.01, 2.0, math.pi)), Navigator(settings, grid)
    navigator.set_goal(goal)
    assert_arrived(robot, drive_to_end(robot, navigator), goal)


def test_a_robot_that_does_not_move_aborts_its_goal_with_that_reason(settings):
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


def test_the_remaining_distance_and_time_are_reported_while_driving(settings):
    grid = room(6.0, 4.0)
    robot, navigator = Robot(grid, Pose2(0.6, 2.0)), Navigator(settings, grid)
    navigator.set_goal(Pose2(5.4, 2.0))
    *driving, last = drive_to_end(robot, navigator)
    left = [decision.progress.distance_left for decision in driving[1:]]
    assert left[0] == pytest.approx(4.8, abs=0.2)
    assert left == sorted(left, reverse=True)
    half = len(driving) // 2
    assert driving[half].progress.seconds_left == pytest.approx(half * PERIOD, rel=0.5)
    assert (last.progress, last.outcome.code, last.outcome.reason) == (None, 0, "SUCCESS")


def test_the_same_run_gives_the_same_poses(settings):
    def poses():
        grid = two_rooms(0.9)
        robot, navigator = Robot(grid, Pose2(0.6, 0.6)), Navigator(settings, grid)
        navigator.set_goal(Pose2(5.4, 3.4))
        drive_to_end(robot, navigator)
        return robot.now, robot.pose

    assert poses() == poses()


def test_the_separate_arguments_of_earlier_versions_give_the_same_decision(settings):
    decisions = []
    for is_old in (False, True):
        robot, navigator = Robot(room(4.0, 4.0), Pose2(1.0, 2.0)), Navigator(settings, room(4.0, 4.0))
        navigator.set_goal(Pose2(3.0, 2.0))
        base_in_odom, topic = robot.ODOM_IN_MAP.inverse() @ robot.pose, settings.scan_topic
        if is_old:
            with pytest.warns(DeprecationWarning, match="use tick"):
                decisions.append(
                    navigator.tick(0.0, robot.pose, base_in_odom, robot.twist, robot.scan(), latency=0.1)
                )
        else:
            state = RobotState(0.0, robot.pose, base_in_odom, robot.twist)
            inputs = NavigatorInputs([observation_from_scan(topic, robot.scan())], latency=0.1)
            decisions.append(navigator.tick(state, inputs))
    assert decisions[0].command == decisions[1].command
    assert decisions[0].command.v > 0.0
