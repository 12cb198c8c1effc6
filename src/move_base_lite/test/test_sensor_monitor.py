"""Sensors that fail while they publish are reported, and working ones are not."""

import math

import numpy as np
import pytest

from move_base_lite.plausibility import SensorMonitor
from planar import Pose2, Twist2

MIN, MAX, BEAMS, PERIOD = 0.1, 8.0, 100, 0.1
AHEAD = Twist2(0.5, 0.0)


class Drive:
    """A robot that drives ahead in a room, with a SensorMonitor."""

    def __init__(self):
        self.monitor, self.now, self.x = SensorMonitor(), 0.0, 0.0
        self._rng = np.random.default_rng(0)

    def go(self, seconds, scan=lambda ranges: ranges, odometry=lambda pose: pose, v=0.5):
        """Return the first fault, or None."""
        for _ in range(round(seconds / PERIOD)):
            self.now, self.x = self.now + PERIOD, self.x + v * PERIOD
            ranges = scan(self.truth())
            if ranges is not None:
                self.monitor.add_scan(ranges, MIN, MAX, 2.0 * math.pi)
            pose = odometry(Pose2(self.x, 0.0))
            if pose is not None:
                self.monitor.add_odometry(self.now, pose, Twist2(v, 0.0))
            if self.monitor.fault(self.now):
                return self.monitor.fault(self.now)
        return None

    def truth(self):
        angles = np.linspace(-math.pi, math.pi, BEAMS)
        sides = 2.0 / np.maximum(np.abs(np.sin(angles)), 0.2)
        walls = np.where(np.cos(angles) > 0.5, 20.0 - self.x, sides) + self._rng.normal(0.0, 0.01, BEAMS)
        return np.where(walls < MAX, walls, np.inf).astype(np.float32)


@pytest.fixture
def drive():
    started = Drive()
    assert started.go(2.0) is None
    return started


def filled(value):
    return lambda ranges: np.full_like(ranges, value)


@pytest.mark.parametrize(
    "value, why",
    [
        (math.nan, "NaN"),
        (math.inf, "lost sight"),
        (0.0, "nearer than"),
        (0.05, "nearer than"),
        (-1.0, "nearer"),
    ],
)
def test_a_scan_without_valid_returns_is_reported_within_half_a_second(drive, value, why):
    fault = drive.go(0.5, scan=filled(value))
    assert fault.startswith("scan: ") and why in fault


def test_a_frozen_scan_is_reported_once_the_robot_has_moved(drive):
    frozen = drive.truth()
    fault = drive.go(1.0, scan=lambda _: frozen)
    assert fault == "scan: it stays the same to the last bit while the robot moves"


def test_a_scan_that_stays_the_same_while_the_robot_stands_is_no_fault(drive):
    frozen = drive.truth()
    assert drive.go(5.0, scan=lambda _: frozen, v=0.0) is None


def test_a_teleported_robot_has_no_frozen_scan(drive):
    """Odometry arrives shortly before the first scan at the new pose."""
    here = drive.truth()
    assert drive.go(0.3, scan=lambda _: here, v=0.0) is None
    drive.x += 3.0
    assert drive.go(0.1, scan=lambda _: here, v=0.0) is None
    there = drive.truth()
    assert drive.go(3.0, scan=lambda _: there, v=0.0) is None


def test_missing_odometry_is_reported(drive):
    assert "odometry: none for" in drive.go(3.0, odometry=lambda _: None)


def test_odometry_that_stands_still_while_scans_change_is_reported(drive):
    stuck = Pose2(drive.x, 0.0)
    angles = np.linspace(-math.pi, math.pi, BEAMS)
    moving = lambda ranges: (ranges + drive.x * np.cos(angles)).astype(np.float32)  # noqa: E731
    assert "odometry: it stands still" in drive.go(5.0, scan=moving, odometry=lambda _: stuck)


def test_odometry_that_stands_still_is_reported_while_commands_alternate_between_fast_and_slow(drive):
    stuck = Pose2(drive.x, 0.0)
    angles = np.linspace(-math.pi, math.pi, BEAMS)
    moving = lambda ranges: (ranges + drive.x * np.cos(angles)).astype(np.float32)  # noqa: E731
    faults = [drive.go(PERIOD, moving, lambda _: stuck, v) for _ in range(20) for v in (0.38, 0.02)]
    assert any("odometry: it stands still" in (fault or "") for fault in faults)


def test_a_blocked_robot_has_no_sensor_fault(drive):
    at = drive.x
    assert drive.go(5.0, scan=lambda _: drive.truth(), odometry=lambda _: Pose2(at, 0.0), v=0.0) is None


def test_the_middle_of_an_empty_hall_is_no_fault():
    assert Drive().go(20.0, scan=filled(math.inf)) is None


def test_a_robot_that_drives_into_open_space_has_no_fault(drive):
    def opening(ranges):
        return np.where(np.arange(BEAMS) < max(0.0, BEAMS * (1.0 - (drive.x - 1.0) / 3.0)), ranges, np.inf)

    assert drive.go(10.0, scan=opening) is None


def test_a_reset_discards_all_data(drive):
    assert drive.go(0.5, scan=filled(math.nan))
    drive.monitor.reset()
    assert drive.monitor.fault(drive.now + 100.0) is None


class Camera:
    """A SensorMonitor with a depth camera in front of a wall; pixels without a measurement are NaN."""

    NEAREST, FARTHEST, SPAN = 0.45, 5.0, math.radians(58.0)

    def __init__(self):
        self.monitor = SensorMonitor()

    def observe(self, distance, yaw=0.0, wall=3.0):
        self.monitor.add_odometry(0.0, Pose2(wall - distance, 0.0, yaw), AHEAD)
        self.add_ranges(distance / np.cos(np.linspace(-self.SPAN / 2.0, self.SPAN / 2.0, BEAMS)))
        return self.monitor.fault(0.0)

    def add_ranges(self, ranges):
        is_measured = (ranges >= self.NEAREST) & (ranges <= self.FARTHEST)
        measured = np.where(is_measured, ranges, math.nan).astype(np.float32)
        self.monitor.add_scan(measured, self.NEAREST, 10.0, self.SPAN)

    def blank(self):
        self.add_ranges(np.full(BEAMS, math.nan))
        return self.monitor.fault(0.0)


def test_a_depth_camera_too_close_to_a_wall_has_no_fault():
    camera = Camera()
    assert [camera.observe(distance) for distance in np.arange(3.0, 0.2, -0.05)] == [None] * 56


def test_a_depth_camera_that_turns_to_open_space_has_no_fault():
    camera = Camera()
    assert camera.observe(2.0) is None
    assert camera.observe(9.0, yaw=0.5, wall=10.0) is None


def test_a_depth_camera_that_fails_in_a_room_is_reported():
    camera = Camera()
    for distance in (4.5, 3.0, 2.5, 2.4):
        assert camera.observe(distance) is None
    assert "lost sight" in camera.blank()
