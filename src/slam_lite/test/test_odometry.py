"""Odometry is mended by what scans tell of its constant errors, and believed as its random ones deserve."""

import numpy as np
import pytest

from planar import Pose2
from slam_lite.config import MapperSettings
from slam_lite.odometry import Odometry

PER_WAY, PER_TURN, SCALE = 0.006, 0.04, 0.03


def learned(noise=0.002, motions=600, slips=0):
    rng, odometry = np.random.default_rng(0), Odometry(MapperSettings())
    for i in range(motions):
        true = Pose2(0.3, 0.0, rng.choice([0.0, 0.0, 0.3, -0.2]))
        yaw = true.yaw * (1.0 + PER_TURN) + PER_WAY * true.x + rng.normal(0.0, noise)
        told = Pose2(true.x * (1.0 + SCALE) + rng.normal(0.0, 0.003), 0.0, yaw)
        if i < slips:
            true = true @ Pose2(-0.3, 0.0, 0.5)
        odometry.learn(told, true)
    return odometry


def told(true):
    return Pose2(true.x * (1.0 + SCALE), 0.0, true.yaw * (1.0 + PER_TURN) + PER_WAY * true.x)


@pytest.mark.parametrize("true", [Pose2(0.3, 0.0, 0.0), Pose2(0.0, 0.0, 0.5), Pose2(0.2, 0.0, -0.3)])
def test_constant_errors_are_learned_and_taken_off(true):
    mended = learned().mended(told(true))
    assert mended.x == pytest.approx(true.x, abs=0.002)
    assert mended.yaw == pytest.approx(true.yaw, abs=0.002)


def test_of_slips_nothing_is_learned():
    mended = learned(slips=60).mended(told(Pose2(0.3, 0.0, 0.0)))
    assert mended.yaw == pytest.approx(0.0, abs=0.003)


def test_what_is_random_is_believed_as_it_is_and_never_less_than_the_settings_say():
    motion, settings = Pose2(0.3, 0.0, 0.0), Odometry(MapperSettings())
    believed = settings.believed_variance(motion)
    np.testing.assert_allclose(settings.variance(motion), believed)
    assert 0.002 < np.sqrt(learned(noise=0.006).variance(motion)[2]) < 0.02
    assert (learned(noise=0.25).variance(motion) <= believed).all()


def test_before_anything_is_known_odometry_is_taken_as_it_is():
    motion = Pose2(0.3, 0.01, -0.1)
    assert Odometry(MapperSettings()).mended(motion) == motion


def test_a_turn_by_half_a_circle_is_no_error_of_a_whole_one():
    odometry = Odometry(MapperSettings())
    for _ in range(20):
        odometry.learn(Pose2(0.3, 0.0, np.pi - 0.01), Pose2(0.3, 0.0, -np.pi + 0.01))
    assert odometry.mended(Pose2(0.3, 0.0, 0.5)).yaw == pytest.approx(0.5, abs=0.02)
