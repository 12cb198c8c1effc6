"""Rays of range finders: resolution, rows, single beams, and lasers that are not level."""

import math

import numpy as np
import pytest

from planar import Pose2
from sim_bridge import Scene, SimulationSettings
from sim_bridge.description import read_urdf_robot
from sim_bridge.errors import RobotError
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.geometry.shapes import Box, Plane
from sim_bridge.noise import NOISE_PROFILES
from sim_bridge.world import Body, Collision, World

PART = """<link name="{name}"><inertial><origin xyz="0 0 {height}"/><mass value="{mass}"/>
<inertia ixx="0.05" iyy="0.05" izz="0.05"/></inertial><collision><origin xyz="0 0 {height}" rpy="{roll} 0 0"/>
<geometry>{shape}</geometry></collision></link>"""
JOINT = """<joint name="{name}_joint" type="{kind}"><parent link="base"/><child link="{name}"/>
<origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="0 1 0"/></joint>"""
DRIVE = """<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so"><leftJoint>left_joint</leftJoint>
<rightJoint>right_joint</rightJoint><wheelSeparation>0.3</wheelSeparation><wheelDiameter>0.1</wheelDiameter>
</plugin></gazebo>"""
LASER = """<link name="laser"/><gazebo reference="laser"><sensor type="ray" name="s"><ray><scan>{scan}</scan>
<range><min>0.1</min><max>{reach}</max></range>{noise}</ray>
<plugin name="p" filename="libgazebo_ros_laser.so"><topicName>scan</topicName><frameName>laser</frameName>
</plugin></sensor></gazebo>"""
HEIGHT = 0.4  # of the laser above the floor


def horizontal(samples, low, high, more=""):
    return (
        f"<horizontal><samples>{samples}</samples>{more}<min_angle>{low}</min_angle>"
        f"<max_angle>{high}</max_angle></horizontal>"
    )


def robot_with(scan, rpy="0 0 0", noise="", reach=8):
    wheels = [
        PART.format(name=side, height=0, mass=0.5, roll=math.pi / 2,
                    shape='<cylinder radius="0.05" length="0.02"/>')
        + JOINT.format(name=side, kind="continuous", xyz=f"0 {y} 0.05", rpy="0 0 0")
        for side, y in (("left", 0.15), ("right", -0.15))
    ]  # fmt: skip
    body = PART.format(name="base", height=0.07, mass=5, roll=0, shape='<box size="0.3 0.2 0.1399"/>')
    mount = JOINT.format(name="laser", kind="fixed", xyz=f"0 0 {HEIGHT}", rpy=rpy)
    laser = LASER.format(scan=scan, noise=noise, reach=reach)
    return read_urdf_robot(f"<robot name='r'>{body}{''.join(wheels)}{laser}{mount}{DRIVE}</robot>", "r.urdf")


def box(name, size, x=0.0, y=0.0, z=0.0, retro=0.0):
    return Body(f"{name}::link", pose3(x, y, z), (Collision(Box(size), np.eye(4), retro),))


FLOOR = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
WALL = box("wall", (0.2, 20.0, 4.0), x=3.1, z=2.0, retro=500.0)


def scan_of(robot, *bodies, yaw=0.0):
    settings = SimulationSettings(**vars(NOISE_PROFILES["ideal"]))
    scene = Scene(World("w", (FLOOR, *bodies)), settings)
    scene.add_robot("r", robot, Pose2(yaw=yaw))
    for _ in range(20):
        scan = scene.step()["r"].scan
        if scan is not None:
            return scan
    raise AssertionError("no scan")


def angles_of(scan):
    return scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))


@pytest.mark.parametrize(("resolution", "count"), [(2, 18), (0.5, 4), (1, 9)])
def test_resolution_times_samples_is_the_number_of_ranges(resolution, count):
    robot = robot_with(horizontal(9, -0.8, 0.8, f"<resolution>{resolution}</resolution>"))
    scan = scan_of(robot, WALL)
    assert len(scan.ranges) == count
    assert scan.angle_increment == pytest.approx(1.6 / (count - 1))
    assert (scan.angle_min, angles_of(scan)[-1]) == (pytest.approx(-0.8), pytest.approx(0.8))


def test_ranges_between_rays_are_interpolated():
    scan = scan_of(robot_with(horizontal(3, -0.8, 0.8, "<resolution>1.7</resolution>")), WALL)
    rays = 3.0 / np.cos([-0.8, 0.0, 0.8])
    between = np.interp(np.linspace(0.0, 2.0, 5), [0, 1, 2], rays)
    assert scan.ranges == pytest.approx(between, abs=2e-3)


def test_a_ray_without_a_hit_counts_with_the_largest_range_between_rays():
    robot = robot_with(horizontal(2, 0.0, 3.0, "<resolution>1.5</resolution>"))
    assert scan_of(robot, WALL).ranges == pytest.approx([3.0, (3.0 + 8.0) / 2.0, np.inf], abs=2e-3)


def test_a_single_beam_measures_ahead_of_it():
    scan = scan_of(robot_with(horizontal(1, 0.3, 0.3)), WALL)
    assert scan.ranges == pytest.approx([3.0 / math.cos(0.3)], abs=2e-3)
    assert (scan.angle_min, scan.angle_increment) == (0.3, 0.0)


@pytest.mark.parametrize("tilt", [0.2, -0.2])
def test_a_laser_that_is_pitched_measures_along_its_tilted_plane(tilt):
    scan = scan_of(robot_with(horizontal(61, -0.9, 0.9), rpy=f"0 {tilt} 0"), WALL)
    bearings = angles_of(scan)
    ahead, down = np.cos(bearings) * math.cos(tilt), np.cos(bearings) * math.sin(tilt)
    with np.errstate(divide="ignore"):
        floor = np.where(down > 0.0, HEIGHT / down, np.inf)
    assert scan.ranges == pytest.approx(np.minimum(3.0 / ahead, floor), abs=0.02)
    assert (scan.ranges.min() < 2.1) == (tilt > 0.0), "a laser that is pitched down sees the floor"


def test_an_upright_laser_sweeps_a_vertical_plane():
    scan = scan_of(robot_with(horizontal(91, -1.5, 1.5), rpy=f"{math.pi / 2} 0 0"), WALL)
    bearings = angles_of(scan)
    expected = np.full(91, np.inf)
    for index, bearing in enumerate(bearings):
        wall = 3.0 / math.cos(bearing)
        up = HEIGHT + wall * math.sin(bearing)
        expected[index] = min(
            wall if up < 4.0 else np.inf, HEIGHT / -math.sin(bearing) if bearing < 0 else np.inf
        )
    expected[expected > 8.0] = np.inf
    seen = np.isfinite(expected)
    assert np.array_equal(seen, np.isfinite(scan.ranges))
    assert scan.ranges[seen] == pytest.approx(expected[seen], abs=0.02)


def test_a_tilted_laser_turns_with_the_robot_and_does_not_see_it():
    scan = scan_of(robot_with(horizontal(31, -3.1, 3.1), rpy="0 1.0 0"), WALL, yaw=math.pi)
    assert np.isfinite(scan.ranges[15])
    assert scan.ranges[15] == pytest.approx(
        HEIGHT / math.sin(1.0), abs=0.02
    ), "the floor below the robot's body"


def test_a_tilted_laser_reads_laser_retro():
    scan = scan_of(robot_with(horizontal(3, -0.1, 0.1), rpy="0 -0.1 0"), WALL)
    assert scan.intensities == pytest.approx([500.0] * 3)


def test_rows_of_rays_follow_each_other_as_gazebo_ros_laser_publishes_them():
    vertical = (
        "<vertical><samples>3</samples><min_angle>-0.3</min_angle><max_angle>0.3</max_angle></vertical>"
    )
    robot = robot_with(horizontal(5, -0.4, 0.4) + vertical)
    scan = scan_of(robot, WALL)
    bearings = np.linspace(-0.4, 0.4, 5)
    rows = []
    for elevation in (-0.3, 0.0, 0.3):
        wall = 3.0 / (np.cos(bearings) * math.cos(elevation))
        rows.append(np.minimum(wall, HEIGHT / math.sin(0.3)) if elevation < 0 else wall)
    assert scan.ranges == pytest.approx(np.concatenate(rows), abs=0.02)
    assert scan.angle_increment == pytest.approx(0.2)


def test_a_single_row_has_no_elevation_as_in_gazebo():
    vertical = "<vertical><samples>1</samples><min_angle>0.5</min_angle><max_angle>0.5</max_angle></vertical>"
    assert robot_with(horizontal(9, -1, 1) + vertical).laser.grid is None


def test_the_mean_of_the_noise_shifts_the_ranges():
    noise = "<noise><type>gaussian</type><mean>0.25</mean><stddev>0</stddev></noise>"
    scan = scan_of(robot_with(horizontal(3, -0.1, 0.1), noise=noise), WALL)
    assert scan.ranges == pytest.approx(3.25 / np.cos([-0.1, 0.0, 0.1]), abs=0.01)


@pytest.mark.parametrize(
    ("scan", "message"),
    [
        (horizontal(5, 0.5, -0.5), "expected min_angle < max_angle for 5 samples, got 0.5 and -0.5"),
        (horizontal(5, 0.5, 0.5), "expected min_angle < max_angle for 5 samples, got 0.5 and 0.5"),
        (horizontal(5, -1, 1, "<resolution>0.1</resolution>"), "expected 1 to 100000 ranges .* got 0"),
        (horizontal(0, -1, 1), "samples: must be a whole number from 1"),
    ],
)
def test_a_sweep_that_is_not_valid_is_refused(scan, message):
    with pytest.raises(RobotError, match=message):
        robot_with(scan)
