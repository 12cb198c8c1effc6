"""Where sensor data are marked: in the frame of their header, at their stamp.

The right values are those of costmap_2d: observation_buffer.cpp (``bufferCloud``), obstacle_layer.cpp
(``updateBounds``), laser_geometry (``projectLaser``).
"""

import math

import numpy as np
import pytest
from robot_in_picture import room

from move_base_lite import MoveBase, PoseHistory, settings_from_parameters
from move_base_lite.costmap import LETHAL
from move_base_lite.move_base import Measurement
from planar import Pose2, Scan, Twist2

# Angle between beams of the laser [rad].
STEP = math.radians(1.0)


def pose(x=0.0, y=0.0, z=0.0, roll=0.0, pitch=0.0, yaw=0.0):
    """A pose in space (4, 4); angles as in URDF."""
    matrix = np.eye(4)
    for axis, angle in ((2, yaw), (1, pitch), (0, roll)):
        turn, (i, j) = np.eye(4), ((1, 2), (2, 0), (0, 1))[axis]
        turn[i, i] = turn[j, j] = math.cos(angle)
        turn[i, j], turn[j, i] = -math.sin(angle), math.sin(angle)
        matrix = matrix @ turn
    matrix[:3, 3] = x, y, z
    return matrix


class FramesOverTime(PoseHistory):
    """Poses of a robot with frames that move; a frame is known from its first to its last known time."""

    def __init__(self):
        super().__init__()
        self.frames = {}
        self.base = lambda stamp: np.eye(4)

    def base_in_space(self, stamp):
        return self.base(stamp)

    def frame_in_base(self, frame, stamp):
        return self.frames.get(frame, lambda stamp: None)(stamp)

    def missing_transform(self, frames, stamp):
        return f"no transform to {frames[0]}"


class Robot:
    """MoveBase with one observation source; tf is a FramesOverTime."""

    def __init__(self, data_type="LaserScan", base_speed=0.0, **source):
        obstacles = {
            "observation_sources": "sensor",
            "sensor": {"data_type": data_type, "clearing": True, **source},
        }
        costmap = {
            "obstacle_layer": obstacles,
            "plugins": [{"name": "obstacle_layer", "type": "costmap_2d::ObstacleLayer"}],
        }
        fixed = {
            "width": 8.0,
            "height": 8.0,
            "resolution": 0.05,
            "rolling_window": True,
            "update_frequency": 10.0,
            "footprint_clearing_enabled": False,
        }
        settings, _ = settings_from_parameters(
            {
                "robot_radius": 0.1,
                "global_costmap": {
                    **costmap,
                    **fixed,
                    "global_frame": "map",
                    "robot_base_frame": "base_footprint",
                },
                "local_costmap": {
                    **costmap,
                    **fixed,
                    "global_frame": "odom",
                    "robot_base_frame": "base_footprint",
                },
            }
        )
        self.poses, self.speed, self.now = FramesOverTime(), base_speed, 0.0
        self.move_base = MoveBase(settings, self.poses, room(6.0, 6.0))
        self.complaints = []

    def tick(self, *measured):
        """Add measurements ``(frame, stamp, data)`` and tick."""
        base = Pose2(self.speed * self.now)
        self.poses.add_odometry(self.now, base)
        self.poses.set_odom_in_map(Pose2())
        self.move_base.add_odometry(self.now, base, Twist2(self.speed))
        for frame, stamp, data in measured:
            scan = data if isinstance(data, Scan) else None
            self.move_base.inputs.add(Measurement("sensor", stamp, lambda data=data: data, frame, scan))
        self.complaints += self.move_base.tick(self.now).complaints
        self.now += 0.1

    def marks(self):
        """Positions of lethal cells in odom, (N, 2), rounded to cells [m]."""
        costmap = self.move_base.navigator.local_costmap
        row_col = np.argwhere(costmap.costs == LETHAL)
        window = costmap.window
        return np.column_stack(
            (window.origin_x + (row_col[:, 1] + 0.5) * 0.05, window.origin_y + (row_col[:, 0] + 0.5) * 0.05)
        )


def scan(stamp=0.0, hits=(), beams=360, range_max=8.0, background=np.inf):
    """A scan that sees a point at each ``(bearing, range)``."""
    ranges = np.full(beams, background)
    for bearing, distance in hits:
        ranges[round((bearing + math.pi) / STEP) % beams] = distance
    return Scan(stamp, -math.pi, STEP, ranges, 0.1, range_max)


def assert_marks(robot, *points_xy):
    marks = robot.marks()
    assert len(marks) == len(points_xy), marks
    for point in points_xy:
        assert np.hypot(*(marks - point).T).min() < 0.05


@pytest.mark.parametrize("sensor_frame", ["", "base_footprint"])
def test_data_of_a_laser_keep_the_frame_of_their_header(sensor_frame):
    """A laser that looks backwards sees an obstacle 0.9 m behind, not 0.68 m ahead."""
    robot = Robot(sensor_frame=sensor_frame)
    robot.poses.frames = {
        "laser": lambda stamp: pose(x=-0.11, z=0.2, yaw=math.pi),
        "base_footprint": lambda stamp: np.eye(4),
    }
    robot.tick(("laser", 0.0, scan(hits=[(0.0, 0.79)])))
    assert_marks(robot, (-0.9, 0.0))


def test_a_cloud_in_the_frame_of_the_base_is_not_moved_by_the_mounting_of_its_camera():
    robot = Robot("PointCloud2", sensor_frame="camera_link")
    robot.poses.frames = {
        "base_footprint": lambda stamp: np.eye(4),
        "camera_link": lambda stamp: pose(x=0.2, z=0.3, yaw=0.5),
    }
    robot.tick(("base_footprint", 0.0, np.array([[1.0, 0.5, 0.2]])))
    assert_marks(robot, (1.0, 0.5))


def test_rays_begin_at_the_sensor_frame():
    """Cells are cleared along rays from ``sensor_frame``, not along those from the frame of the header."""
    robot = Robot("PointCloud2", sensor_frame="mast")
    robot.poses.frames = {"base_footprint": lambda stamp: np.eye(4), "mast": lambda stamp: pose(y=1.0)}
    robot.tick(("base_footprint", 0.0, np.array([[1.0, 0.0, 0.2], [1.0, 0.5, 0.2]])))
    robot.tick(("base_footprint", 0.1, np.array([[2.0, 0.0, 0.2]])))  # its ray crosses (1.0, 0.5) only
    assert_marks(robot, (1.0, 0.0), (2.0, 0.0))


@pytest.mark.parametrize("frame", ["odom", "map"])
def test_an_obstacle_in_clouds_of_a_fixed_frame_is_one_obstacle_while_the_robot_drives(frame):
    robot = Robot("PointCloud2", base_speed=0.5)
    robot.poses.frames = {frame: lambda stamp: pose(x=-0.5 * stamp)}
    robot.poses.base = lambda stamp: pose(x=0.5 * stamp)
    for tick in range(17):
        robot.tick((frame, 0.1 * tick, np.array([[2.025, 0.525, 0.3]])))
    assert_marks(robot, (2.025, 0.525))


def test_data_of_a_turning_mount_are_placed_at_their_stamps():
    robot = Robot()
    robot.poses.frames = {"laser": lambda stamp: pose(z=0.2, yaw=2.0 * stamp)}
    for tick in range(15):
        stamp = 0.1 * tick
        bearing = (math.atan2(0.525, 1.525) - 2.0 * stamp + math.pi) % (2.0 * math.pi) - math.pi
        exact = Scan(stamp, bearing, STEP, np.array([math.hypot(1.525, 0.525)]), 0.1, 8.0)
        robot.tick(("laser", stamp, exact))
    assert_marks(robot, (1.525, 0.525))


def floor_scan(tilt, height):
    """What a laser sees that looks down by ``tilt`` at a flat floor, from ``height``, up to 8 m."""
    angles = -math.pi + STEP * np.arange(360)
    with np.errstate(divide="ignore"):
        ranges = height / (np.cos(angles) * math.sin(tilt))
    return Scan(0.0, -math.pi, STEP, np.where((ranges > 0.0) & (ranges < 8.0), ranges, np.inf), 0.1, 8.0)


def test_a_tilted_laser_marks_no_floor_below_the_lowest_obstacle_height():
    robot = Robot(min_obstacle_height=0.05)
    robot.poses.frames = {"laser": lambda stamp: pose(z=0.3, pitch=0.2)}
    robot.tick(("laser", 0.0, floor_scan(0.2, 0.3)))
    assert_marks(robot)


def test_an_obstacle_in_the_scan_of_a_tilted_laser_is_marked_below_its_end_point():
    robot = Robot(min_obstacle_height=0.05)
    robot.poses.frames = {"laser": lambda stamp: pose(z=0.3, pitch=0.2)}
    robot.tick(("laser", 0.0, scan(hits=[(0.0, 1.0)])))  # its height is 0.3 - sin(0.2) = 0.10 m
    assert_marks(robot, (math.cos(0.2), 0.0))


def test_heights_are_above_the_floor_when_the_base_is_pitched():
    """The frame of the base may be above the floor and inclined, as base_link on a ramp."""
    robot = Robot(min_obstacle_height=0.05)
    robot.poses.base = lambda stamp: pose(z=0.1, pitch=0.2)
    robot.poses.frames = {"laser": lambda stamp: pose(z=0.1)}
    robot.tick(("laser", 0.0, scan(hits=[(0.0, 0.9), (math.pi / 2, 0.5)])))
    assert_marks(robot, (math.sin(0.2) * 0.1, 0.5))  # the one ahead is at 0.02 m


def test_an_upright_laser_seen_as_3_14_rad_upside_down_is_level():
    robot = Robot(min_obstacle_height=0.1, max_obstacle_height=0.3)
    robot.poses.frames = {"laser": lambda stamp: pose(z=0.2, roll=3.14)}
    robot.tick(("laser", 0.0, scan(hits=[(math.pi / 2, 1.0)])))
    assert_marks(robot, (0.0, -1.0))


def test_data_wait_for_their_transform():
    robot = Robot()
    robot.poses.frames = {"laser": lambda stamp: pose() if robot.now >= 0.5 else None}
    robot.tick(("laser", 0.0, scan(hits=[(0.0, 1.0)])))
    assert_marks(robot)
    for _ in range(6):
        robot.tick()
    assert_marks(robot, (1.0, 0.0))
    assert not robot.complaints


def test_a_source_whose_transform_is_missing_is_named_after_a_while_and_not_at_each_tick():
    robot = Robot()
    for tick in range(100):
        robot.tick(("laser", 0.1 * tick, scan(0.1 * tick, hits=[(0.0, 1.0)])))
    assert_marks(robot)
    assert robot.complaints == ["sensor: 1 message dropped after 2 s: no transform to laser"]
    for tick in range(100, 130):
        robot.tick(("laser", 0.1 * tick, scan(0.1 * tick)))
    assert len(robot.complaints) == 2
    assert robot.complaints[1].startswith("sensor: 100 messages dropped")


def test_a_tilted_laser_that_sees_only_floor_is_not_taken_for_a_frozen_one():
    robot = Robot(base_speed=0.3, min_obstacle_height=0.05)
    robot.poses.base = lambda stamp: pose(x=0.3 * stamp)
    robot.poses.frames = {"laser": lambda stamp: pose(z=0.3, pitch=0.2)}
    for tick in range(30):
        robot.tick(("laser", 0.1 * tick, floor_scan(0.2, 0.3)))
        assert robot.move_base.inputs.fault(robot.now) is None
