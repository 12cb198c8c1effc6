"""Docking and undocking of a robot without dynamics."""

import math
from typing import Optional

import numpy as np
import pytest
from robot_at_dock import RobotAtDock

from auto_docking_lite import DockCode, DockController, DockingSettings, DockState, pose_when_docked
from auto_docking_lite.motion import is_free
from planar import Pose2, SettingsError
from planar.driving import DriveOutcome
from planar.geometry.dock_field import DockField


def docking(
    base: Pose2, dock_in_map: Optional[Pose2] = None, settings=DockingSettings(), seed: int = 0, **robot
) -> RobotAtDock:
    """Return a robot that has started to dock."""
    controller = DockController(settings, seed=seed)
    controller.start(0.0, dock_in_map)
    return RobotAtDock(controller, base, **robot)


class Navigation:
    """A move_base that answers at once."""

    def __init__(self, status: str):
        self.status, self.goals, self.cancelled = status, [], 0

    def send(self, goal: Pose2) -> None:
        self.goals.append(goal)

    def outcome(self) -> Optional[DriveOutcome]:
        return DriveOutcome(self.status, "no way") if self.status else None

    def cancel(self) -> None:
        self.cancelled += 1


@pytest.mark.parametrize("distance", [0.5, 1.0, 2.0, 2.4])
@pytest.mark.parametrize("bearing", [-0.9, -0.3, 0.0, 0.3, 0.9])
@pytest.mark.parametrize("yaw", [0.0, 2.0, 4.0])
def test_a_robot_in_the_field_docks_without_knowing_where_the_dock_is(distance, bearing, yaw):
    robot = docking(Pose2(distance * math.cos(bearing), distance * math.sin(bearing), yaw))
    result = robot.run()
    assert result is not None and result.is_success, result
    assert result.text == "Arrived on docking station successfully."
    assert DockField().has_contact(robot.base)


def test_states_are_those_of_kobuki_auto_docking():
    robot = docking(Pose2(1.5, 0.6, 1.0))
    assert robot.run().is_success
    visited = [state for state in robot.states[1:] if state not in ("FIND_STREAM", "GET_STREAM")]
    assert visited == ["SCAN", "ALIGNED", "ALIGNED_FAR", "ALIGNED_NEAR", "DOCKED_IN", "DONE"]


@pytest.mark.parametrize("moved", [Pose2(0.5, 0.0), Pose2(0.0, 0.5), Pose2(-0.3, -0.4, 0.2)])
def test_a_dock_that_was_moved_by_half_a_metre_is_found(moved):
    base = Pose2(3.5, 1.0, 0.5)
    robot = docking(base, base.inverse() @ moved)
    assert robot.run().is_success
    assert "STAGING" in robot.states


@pytest.mark.parametrize("half_angle", [0.02, 0.09])
def test_the_centre_fan_may_have_another_width_than_expected(half_angle):
    field = DockField(dock_centre_half_angle=half_angle)
    results = [docking(Pose2(1.6, y, 0.3), field=field).run() for y in (-0.9, 0.4, 1.1)]
    assert all(result.is_success for result in results), results


def test_without_a_dock_docking_ends_with_a_reason():
    result = docking(Pose2(1.5, 0.0), field=None).run()
    assert result.code is DockCode.FAILED_TO_DETECT_DOCK
    assert result.text.startswith("Aborted: FAILED_TO_DETECT_DOCK (904): no signal of a dock within 2.5 m")


def test_a_known_dock_that_is_gone_is_searched_from_several_poses():
    base = Pose2(1.5, 0.0)
    result = docking(base, base.inverse(), field=None).run()
    assert result.code is DockCode.FAILED_TO_DETECT_DOCK and "5 attempts" in result.text


def test_a_known_dock_that_is_gone_is_searched_where_it_was():
    base = Pose2(1.5, 0.0)
    robot, farthest = docking(base, base.inverse(), field=None), 0.0
    while robot.tick().result is None:
        estimate = robot.controller.estimate()
        if estimate is not None:
            farthest = max(farthest, estimate.dock_in_odom.distance_to(robot.dock_in_odom))
    assert farthest < 1.0


def test_a_dock_that_does_not_charge_ends_docking_with_a_reason():
    robot = docking(Pose2(1.2, 0.1, 3.0), charges=False, settings=DockingSettings(docking_timeout=600.0))
    result = robot.run(600.0)
    assert result.code is DockCode.FAILED_TO_CHARGE and "does not charge" in result.text
    assert "BUMPED" in robot.states


def test_docking_ends_at_its_time_out():
    robot = docking(Pose2(1.2, 0.1, 3.0), charges=False, settings=DockingSettings(docking_timeout=20.0))
    result = robot.run()
    assert result.code is DockCode.TIMEOUT and "20 s" in result.text


def test_the_robot_waits_for_a_person_before_the_dock():
    person = np.array([[0.5, 0.02], [0.5, -0.02]])
    robot = docking(Pose2(0.9, 0.0, math.pi), obstacles_xy=person)
    while robot.now < 8.0:
        assert robot.tick().result is None
    assert robot.base.x > 0.7
    robot.obstacles_xy = np.empty((0, 2))
    assert robot.run().is_success


def test_a_person_who_stays_before_the_dock_ends_docking():
    robot = docking(Pose2(0.9, 0.0, math.pi), obstacles_xy=np.array([[0.45, 0.0]]))
    result = robot.run()
    assert result.code in (DockCode.FAILED_TO_CONTROL, DockCode.FAILED_TO_STAGE)
    assert "before the dock" in result.text


def test_an_obstacle_is_passed():
    box = np.array([[1.3, y] for y in np.linspace(-0.15, 0.15, 7)])
    robot = docking(Pose2(2.0, 0.0, math.pi), obstacles_xy=box)
    assert robot.run().is_success


def test_a_known_dock_stays_at_its_place_in_the_map_while_the_odometry_drifts():
    robot = docking(Pose2(5.0, 0.0), dock_in_map=Pose2(-5.0, 0.0))
    robot.tick()
    robot.odom_in_map = drift = Pose2(0.4, 0.9, 0.1)
    robot.tick()
    expected = drift.inverse() @ Pose2(-5.0, 0.0)
    assert robot.controller.estimate().dock_in_odom.distance_to(expected) < 0.05


@pytest.mark.parametrize("seed", range(8))
def test_a_box_at_the_staging_pose_is_no_reason_to_fail(seed):
    box = np.array([[x, y] for x in (0.8, 0.85, 0.9, 0.95, 1.0) for y in (0.18, 0.23, 0.28)])
    base = Pose2(2.8, -0.5, 0.3)
    assert docking(base, base.inverse(), seed=seed, obstacles_xy=box).run().is_success


def test_navigation_drives_to_a_distant_dock_behind_obstacles():
    navigation = Navigation("")
    controller = DockController(DockingSettings(), navigation)
    base, ring = Pose2(4.0, 0.0), np.linspace(-math.pi, math.pi, 200)
    robot = RobotAtDock(controller, base, obstacles_xy=np.column_stack((4.0 + np.cos(ring), np.sin(ring))))
    controller.start(0.0, robot.dock_in_odom)
    robot.tick()
    assert robot.tick().command is None and len(navigation.goals) == 1
    staged = robot.dock_in_odom @ Pose2(0.9, 0.0, math.pi)
    assert navigation.goals[0].distance_to(staged) < 0.15
    controller.cancel(robot.now)
    assert robot.tick().result.code is DockCode.CANCELLED and navigation.cancelled == 1


def test_navigation_that_fails_ends_docking():
    controller = DockController(DockingSettings(), Navigation("ABORTED"))
    base, ring = Pose2(4.0, 0.0), np.linspace(-math.pi, math.pi, 200)
    robot = RobotAtDock(controller, base, obstacles_xy=np.column_stack((4.0 + np.cos(ring), np.sin(ring))))
    controller.start(0.0, robot.dock_in_odom)
    result = robot.run()
    assert result.code is DockCode.FAILED_TO_STAGE and "no way" in result.text


def test_cancelling_stops_the_robot():
    robot = docking(Pose2(1.5, 0.3))
    for _ in range(20):
        robot.tick()
    robot.controller.cancel(robot.now)
    decision = robot.tick()
    assert decision.result.text == "Cancelled: Cancel requested."
    assert (decision.command.v, decision.command.omega) == (0.0, 0.0)
    assert robot.tick().command is None and not robot.controller.is_active


def test_no_signal_of_an_earlier_goal_is_used():
    robot = docking(Pose2(1.5, 0.3))
    for _ in range(100):
        robot.tick()
    robot.field = None
    robot.controller.start(robot.now)
    assert robot.run().code is DockCode.FAILED_TO_DETECT_DOCK


def test_undocking_leaves_the_dock_backwards():
    robot = RobotAtDock(DockController(), pose_when_docked(Pose2(0.02)))
    robot.controller.undock(0.0)
    result = robot.run()
    assert result.is_success and 0.6 < robot.base.x < 0.75 and abs(robot.base.y) < 0.01


def test_undocking_waits_for_what_is_behind_and_then_gives_up():
    behind = np.array([[0.45, 0.0]])
    robot = RobotAtDock(DockController(), pose_when_docked(Pose2(0.02)), obstacles_xy=behind)
    robot.controller.undock(0.0)
    result = robot.run()
    assert result.code is DockCode.FAILED_TO_CONTROL and "behind the robot" in result.text
    assert 9.0 < robot.now < 13.0


def test_a_robot_that_is_docked_already_is_docked_again_at_once():
    robot = docking(pose_when_docked(Pose2(0.02)))
    assert robot.run().is_success and robot.now < 2.0


def test_the_same_seed_gives_the_same_run():
    ends = []
    for _ in range(2):
        robot = docking(Pose2(1.5, 0.8, 2.0))
        robot.run()
        ends.append(robot.base)
    assert ends[0] == ends[1]


def test_nothing_is_commanded_without_a_task():
    decision = RobotAtDock(DockController(), Pose2(1.0)).tick()
    assert decision.command is None and decision.state is DockState.IDLE


@pytest.mark.parametrize(
    "name, value", [("max_speed", 0.0), ("staging_distance", 0.1), ("dock_far_range", -1.0)]
)
def test_a_senseless_setting_is_an_error(name, value):
    with pytest.raises(SettingsError, match=name):
        DockingSettings(**{name: value})


def test_an_obstacle_that_touches_the_robot_does_not_keep_it_from_leaving():
    assert is_free(np.array([[-0.19, 0.0]]), Pose2(), Pose2(1.0), 0.18)
    assert not is_free(np.array([[0.19, 0.0]]), Pose2(), Pose2(1.0), 0.18)
