"""Scans of the range finder and their errors."""

import dataclasses
import math

import numpy as np
import pytest

from planar import Pose2
from sim_bridge.geometry.pose3 import pose3
from sim_bridge.noise import NOISE_PROFILES
from sim_bridge.robots import ROBOTS
from sim_bridge.sensors.lidar import Lidar

LIDAR, KINECT = ROBOTS["turtlebot_lidar"].laser, ROBOTS["turtlebot_kinect"].laser
# A room of 4 m x 4 m whose wall ahead reflects.
ROOM = np.array([[2, -2, 2, 2], [2, 2, -2, 2], [-2, 2, -2, -2], [-2, -2, 2, -2]], dtype=float)
RETROS = np.array([1000.0, 0.0, 0.0, 0.0])
NOTHING = np.empty((0, 4))


def sweep(profile=LIDAR, seed=0, segments=ROOM, **noise):
    here = dataclasses.replace(profile, pose_in_base=np.eye(4))
    lidar = Lidar(here, dataclasses.replace(NOISE_PROFILES["ideal"], **noise), np.random.default_rng(seed))
    return lidar.sweep(1.5, segments, RETROS[: len(segments)], Pose2())


def true_range(scan):
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    return 2.0 / np.maximum(np.abs(np.cos(angles)), np.abs(np.sin(angles)))


def test_an_ideal_laser_measures_true_ranges():
    scan = sweep()
    assert scan.stamp == 1.5
    assert scan.ranges == pytest.approx(true_range(scan), abs=1e-5)


def test_noise_has_the_deviation_asked_for():
    errors = np.concatenate([sweep(seed=seed, range_noise=0.02).ranges for seed in range(50)])
    errors -= np.tile(true_range(sweep()), 50)
    assert errors.std() == pytest.approx(0.02, rel=0.03), "18000 beams: 3 sigma are 1.6 %"
    assert abs(errors.mean()) < 3.0 * 0.02 / math.sqrt(len(errors))


@pytest.mark.parametrize(("profile", "is_lost"), [(LIDAR, np.isposinf), (KINECT, np.isnan)])
def test_beams_drop_out_and_read_the_greatest_range_as_often_as_asked_for(profile, is_lost):
    ranges = np.concatenate(
        [
            sweep(profile, seed, range_dropouts=0.1, range_max_readings=0.05).ranges
            for seed in range(0, 36000, profile.beams)
        ]
    )
    assert is_lost(ranges).mean() == pytest.approx(0.1, abs=0.006)
    assert (ranges == profile.range_max).mean() == pytest.approx(0.05, abs=0.004)


@pytest.mark.parametrize(("profile", "is_lost"), [(LIDAR, np.isposinf), (KINECT, np.isnan)])
def test_beams_without_return_read_as_the_profile_states(profile, is_lost):
    assert is_lost(sweep(profile, segments=NOTHING).ranges).all()


def test_reflective_walls_have_high_intensity():
    scan = sweep()
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    ahead = np.abs(angles) < math.radians(44.0)
    assert (scan.intensities[ahead] == 1000.0).all()
    assert (scan.intensities[np.abs(angles) > math.radians(46.0)] == 0.0).all()
    assert len(scan.intensities) == len(scan.ranges)


def test_the_same_seed_makes_the_same_errors():
    noise = {"range_noise": 0.01, "range_dropouts": 0.1}
    assert np.array_equal(sweep(seed=3, **noise).ranges, sweep(seed=3, **noise).ranges)
    assert not np.array_equal(sweep(seed=3, **noise).ranges, sweep(seed=4, **noise).ranges)


def test_a_laser_mounted_upside_down_sweeps_in_reverse():
    profile = dataclasses.replace(LIDAR, pose_in_base=pose3(roll=math.pi))
    lidar = Lidar(profile, NOISE_PROFILES["ideal"], np.random.default_rng(0))
    wall_on_the_left = np.array([[-5.0, 2.0, 5.0, 2.0]])
    scan = lidar.sweep(0.0, wall_on_the_left, np.zeros(1), Pose2())
    assert scan.upside_down
    assert scan.ranges[90] == pytest.approx(2.0), "what is on the left is at -90 degrees for it"
    assert np.isposinf(scan.ranges[270])
