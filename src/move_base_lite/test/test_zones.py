"""Zones: the robot stays out of keep-out zones, leaves them, and slows down in speed zones."""

import math

import pytest
from robot_in_picture import SETTINGS, Robot, assert_arrived, drive_to_end, room

from move_base_lite import Navigator, Status
from move_base_lite.navigator.zones import NavigationZone, Zones, load_zones
from planar import Pose2, SettingsError

MIDDLE = NavigationZone("middle", "keep_out", ((2.4, 0.0), (3.6, 0.0), (3.6, 2.6), (2.4, 2.6)))
SLOW = NavigationZone("slow", "speed", ((2.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 4.0)), max_speed=0.2)


def drive(zones, start, goal):
    grid = room(6.0, 4.0)
    robot, navigator = Robot(grid, start), Navigator(SETTINGS, grid, zones)
    navigator.set_goal(goal)
    poses, speeds = [], []
    while robot.now < 90.0:
        decision = robot.tick(navigator)
        poses.append(robot.pose)
        speeds.append(robot.twist.v)
        if decision.status.is_final:
            return robot, decision, poses, speeds
    raise AssertionError("the goal has not ended after 90 s")


def test_the_whole_robot_stays_out_of_a_keep_out_zone():
    goal = Pose2(5.4, 1.5)
    robot, decision, poses, _ = drive(Zones([MIDDLE]), Pose2(0.6, 1.5), goal)
    assert_arrived(robot, [decision], goal)
    within = [pose for pose in poses if 2.4 - 0.178 < pose.x < 3.6 + 0.178]
    assert min(pose.y for pose in within if 2.4 < pose.x < 3.6) > 2.6 + 0.178


def test_a_zone_that_is_switched_off_has_no_effect():
    zones, goal = Zones([MIDDLE]), Pose2(5.4, 1.5)
    zones.enable("middle", False)
    robot, decision, poses, _ = drive(zones, Pose2(0.6, 1.5), goal)
    assert_arrived(robot, [decision], goal)
    assert max(pose.y for pose in poses) < 2.0


def test_a_robot_in_a_keep_out_zone_leaves_it():
    goal = Pose2(5.4, 1.5)
    robot, decision, poses, _ = drive(Zones([MIDDLE]), Pose2(3.2, 1.0, math.pi), goal)
    assert_arrived(robot, [decision], goal)
    is_inside = [MIDDLE.contains(pose.x, pose.y) for pose in poses]
    assert is_inside == sorted(is_inside, reverse=True), "once it is out, it stays out"
    assert not is_inside[-1]


def test_a_robot_leaves_a_zone_that_is_switched_on_around_it():
    zones, grid, goal = Zones([MIDDLE]), room(6.0, 4.0), Pose2(5.4, 1.5)
    zones.enable("middle", False)
    robot, navigator = Robot(grid, Pose2(0.6, 1.5)), Navigator(SETTINGS, grid, zones)
    navigator.set_goal(goal)
    while robot.pose.x < 2.6:
        robot.tick(navigator)
    zones.enable("middle", True)
    assert_arrived(robot, drive_to_end(robot, navigator), goal)


def test_a_goal_in_a_keep_out_zone_is_aborted_at_once_with_the_name_of_the_zone():
    _, decision, _, _ = drive(Zones([MIDDLE]), Pose2(0.6, 1.5), Pose2(3.0, 1.0))
    assert decision.status is Status.ABORTED
    assert decision.text.endswith(
        "[code=GOAL_BLOCKED: the goal at (3.00, 1.00) is in the keep-out zone middle]"
    )


def test_the_robot_is_slow_in_a_speed_zone():
    goal = Pose2(5.4, 1.5)
    robot, decision, poses, speeds = drive(Zones([SLOW]), Pose2(0.6, 1.5), goal)
    assert_arrived(robot, [decision], goal)
    # It enters at full speed and brakes with 1.5 m/s^2.
    assert max(v for pose, v in zip(poses, speeds) if 2.2 < pose.x < 4.0) <= 0.2 + 1e-6
    assert max(v for pose, v in zip(poses, speeds) if pose.x < 2.0) > 0.4


CORNERS = "corners: [[0, 0], [1, 0], [1, 1]]"


@pytest.mark.parametrize(
    "text, reason",
    [
        ("", "expected a table"),
        ("a: [1", "not valid YAML"),
        ("a: {kind: keep_out}", "a.corners must be at least 3 points"),
        ("a: {kind: lava, corners: []}", "a.kind must be one of keep_out, speed, got 'lava'"),
        ("a: {kind: keep_out, corners: [[0, 0], [1, 0]]}", "a.corners must be at least 3 points"),
        ("a: {kind: keep_out, corners: [[0, 0], [1, 0], [1, .nan]]}", "a.corners must be at least 3 points"),
        (f"a: {{kind: speed, {CORNERS}}}", "a.max_speed is missing"),
        (f"a: {{kind: speed, max_speed: -1, {CORNERS}}}", "a.max_speed must be positive, got -1"),
        (f"a: {{kind: keep_out, max_speed: 1, {CORNERS}}}", 'unknown key "a.max_speed"'),
        (f"a: {{kind: keep_out, enabled: 3, {CORNERS}}}", "a.enabled must be true or false"),
    ],
)
def test_an_invalid_file_of_zones_is_refused_with_file_line_and_key(tmp_path, text, reason):
    path = tmp_path / "zones.yaml"
    path.write_text(text)
    with pytest.raises(SettingsError, match=reason) as error:
        load_zones(path)
    assert str(error.value).startswith(f"{path}:1: ")


def test_a_file_of_zones_is_read(tmp_path):
    path = tmp_path / "zones.yaml"
    path.write_text(
        f"a: {{kind: speed, max_speed: 0.3, {CORNERS}, enabled: false}}\nb: {{kind: keep_out, {CORNERS}}}"
    )
    zones = load_zones(path)
    assert [(zone.name, zone.kind, zone.max_speed) for zone in zones.all] == [
        ("a", "speed", 0.3),
        ("b", "keep_out", math.inf),
    ]
    assert [zones.is_enabled(name) for name in "ab"] == [False, True]


def test_a_missing_file_of_zones_is_named():
    with pytest.raises(SettingsError, match="nowhere.yaml: no such file"):
        load_zones("nowhere.yaml")
