"""MoveBase: what the node does between its messages and the Navigator, without ROS."""

from dataclasses import replace

import numpy as np
import pytest
from robot_in_picture import PERIOD, SETTINGS, Robot, room

from move_base_lite import MoveBase, PoseHistory, Status
from move_base_lite.costmap import LETHAL
from move_base_lite.move_base import Measurement
from planar import OCCUPIED, Pose2, Twist2

START, GOAL = Pose2(1.0, 2.0), Pose2(4.0, 2.0)


class Drive:
    """A robot whose odometry, scans and localization reach MoveBase, unless they are switched off."""

    def __init__(self, **changed):
        grid, self.poses = room(6.0, 4.0), PoseHistory()
        self.robot = Robot(grid, START)
        self.move_base = MoveBase(replace(SETTINGS, **changed), self.poses, grid)
        self.has_odometry = self.has_scan = self.has_localization = True

    def tick(self):
        robot = self.robot
        base_in_odom = robot.ODOM_IN_MAP.inverse() @ robot.pose
        if self.has_odometry:
            self.poses.add_odometry(robot.now, base_in_odom)
            self.move_base.add_odometry(robot.now, base_in_odom, robot.twist)
        if self.has_localization:
            self.poses.set_odom_in_map(robot.ODOM_IN_MAP, robot.now)
        if self.has_scan:
            self.move_base.add_scan(robot.scan())
        result = self.move_base.tick(robot.now)
        robot.drive(result.decision.command or Twist2())
        return result

    def run(self, seconds):
        return [self.tick() for _ in range(round(seconds / PERIOD))]


def test_a_goal_is_reached_with_inputs_as_they_arrive():
    drive = Drive()
    drive.tick()
    drive.move_base.set_goal(GOAL)
    decisions = [result.decision for result in drive.run(20.0)]
    assert Status.SUCCEEDED in [decision.status for decision in decisions]
    assert drive.robot.pose.distance_to(GOAL) < 0.2


def test_nothing_is_decided_before_the_first_pose():
    drive = Drive()
    drive.has_localization = False
    result = drive.tick()
    assert result.state is None
    assert result.decision.status is Status.IDLE
    assert result.decision.text == "waiting for the transform map -> odom"


def test_without_a_goal_a_tick_is_due_when_a_costmap_is():
    local, world = (
        replace(each, update_frequency=2.0) for each in (SETTINGS.local_costmap, SETTINGS.global_costmap)
    )
    drive = Drive(local_costmap=local, global_costmap=world)
    drive.tick()
    due = []
    for _ in range(round(2.0 / PERIOD)):
        due.append(drive.move_base.is_due(drive.robot.now))
        if due[-1]:
            drive.tick()
        else:
            drive.robot.drive(Twist2())
    assert sum(due) == 4
    assert not drive.move_base.is_due(drive.robot.now)
    drive.move_base.set_goal(GOAL)
    assert drive.move_base.is_due(drive.robot.now)


@pytest.mark.parametrize(
    "sensor, complaint",
    [
        ("has_odometry", "waiting for a transform odom -> base_footprint that is not"),
        ("has_localization", "waiting for a transform map -> odom that is not"),
    ],
)
def test_the_robot_stands_while_a_pose_is_too_old_and_drives_on_with_a_new_one(sensor, complaint):
    drive = Drive()
    drive.tick()
    drive.move_base.set_goal(GOAL)
    drive.run(2.0)
    setattr(drive, sensor, False)
    last = drive.run(1.5)[-1]
    assert (last.decision.status, last.decision.command) == (Status.WAITING, Twist2())
    assert last.decision.text.startswith(complaint)
    assert last.state is None
    setattr(drive, sensor, True)
    assert drive.run(1.0)[-1].decision.command.v > 0.1


def test_odometry_that_has_stopped_is_a_fault_whatever_the_age_of_transforms():
    tolerant = {
        name: replace(getattr(SETTINGS, name), transform_tolerance=100.0)
        for name in ("global_costmap", "local_costmap")
    }
    drive = Drive(**tolerant)
    drive.tick()
    drive.move_base.set_goal(GOAL)
    drive.run(1.0)
    drive.has_odometry = False
    results = drive.run(2.5)
    assert results[0].fault is None
    assert results[-1].fault.startswith("odometry: none for 2.")
    assert results[-1].decision.text == f"waiting for a trustworthy sensor ({results[-1].fault})"


def test_a_goal_is_aborted_after_the_patience_with_a_sensor():
    drive = Drive()
    drive.tick()
    drive.move_base.set_goal(GOAL)
    drive.run(1.0)
    drive.has_odometry = False
    results = drive.run(SETTINGS.move_base.sensor_patience + 1.0)
    ends = [result.decision for result in results if result.decision.status.is_final]
    assert [decision.outcome.reason for decision in ends] == ["TF_ERROR"]
    assert "[code=TF_ERROR: waiting for " in ends[0].text
    assert results[-1].decision.status is Status.IDLE


def test_a_delayed_scan_is_seen_from_where_the_robot_is_now():
    drive = Drive()
    drive.tick()
    old = drive.robot.scan()
    drive.has_scan = False
    drive.robot.twist = Twist2(0.5, 0.0)
    drive.run(0.3)
    drive.move_base.add_scan(old)
    drive.tick()
    state = drive.move_base.inputs.state(drive.robot.now)
    drive.move_base.add_scan(old)
    drive.move_base.inputs.check_new(Twist2())
    (observation,) = drive.move_base.inputs.observations(state)
    moved = state.base_in_map.inverse() @ START
    assert moved.x < -0.01
    assert observation.sensor_in_base.x == pytest.approx(moved.x)


def test_inputs_are_checked_in_the_order_of_their_stamps():
    """Over ROS all odometry of a tick arrives before its scan; the scan belongs between them."""
    checked = []
    drive = Drive()
    monitor = drive.move_base.inputs._monitor
    monitor.add_odometry = lambda stamp, *_: checked.append(stamp)
    monitor.add_scan = lambda *_: checked.append("scan")
    scan = replace(drive.robot.scan(), stamp=0.2)
    for stamp in (0.1, 0.2, 0.3):
        drive.move_base.add_odometry(stamp, Pose2(), Twist2())
    drive.move_base.add_scan(scan)
    drive.move_base.inputs.check_new(Twist2())
    assert checked == [0.1, 0.2, "scan", 0.3]


@pytest.mark.parametrize("corner", [Pose2(3.0, 1.0, 0.6), Pose2(-2.0, 5.0, -2.0)])
def test_a_map_whose_origin_is_turned_is_driven_in(corner):
    """map_server documents the yaw of origin; the official costmap_2d and amcl ignore it."""
    grid = replace(room(6.0, 4.0), origin=corner)
    drive = Drive()
    drive.robot = Robot(grid, corner @ START)
    drive.move_base = MoveBase(SETTINGS, drive.poses, grid)
    drive.tick()
    costmap = drive.move_base.navigator.global_costmap
    walls_xy = grid.points_of(np.argwhere(grid.cells == OCCUPIED))
    costs = [costmap.costs[costmap.window.cell_of(x, y)] for x, y in walls_xy]
    assert np.mean(np.array(costs) == LETHAL) > 0.9
    drive.move_base.set_goal(corner @ GOAL)
    statuses = [result.decision.status for result in drive.run(20.0)]
    assert Status.SUCCEEDED in statuses
    assert drive.robot.pose.distance_to(corner @ GOAL) < 0.2


def test_a_cloud_of_a_mounted_camera_is_placed_without_ros():
    drive = Drive()
    drive.poses.set_mounting("camera", Pose2(0.2, 0.0, 1.0).as_matrix())
    drive.tick()
    points_xyz = np.array([[1.0, 0.0, 0.3]])
    drive.move_base.inputs.add(Measurement("cloud", 0.0, lambda: points_xyz, "camera"))
    drive.move_base.inputs.check_new(Twist2())
    state = drive.move_base.inputs.state(0.0)
    (observation,) = (each for each in drive.move_base.inputs.observations(state) if each.topic == "cloud")
    assert (observation.sensor_in_base.x, observation.angles[0]) == pytest.approx((0.2, 1.0))
    assert (observation.ranges[0], observation.heights[0]) == pytest.approx((1.0, 0.3))
