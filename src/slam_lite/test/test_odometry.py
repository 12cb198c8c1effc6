"""The bias of odometry is learned from scan matching, and its variance from the random rest."""

import numpy as np
import pytest

from planar import Pose2
from slam_lite.config import MapperSettings
from slam_lite.odometry.error_model import OdometryErrorModel

PER_DISTANCE, PER_TURN, SCALE = 0.006, 0.04, 0.03


def learned(noise=0.002, motions=600, slips=0):
    rng, odometry = np.random.default_rng(0), OdometryErrorModel(MapperSettings())
    for i in range(motions):
        true = Pose2(0.3, 0.0, rng.choice([0.0, 0.0, 0.3, -0.2]))
        yaw = true.yaw * (1.0 + PER_TURN) + PER_DISTANCE * true.x + rng.normal(0.0, noise)
        measured = Pose2(true.x * (1.0 + SCALE) + rng.normal(0.0, 0.003), 0.0, yaw)
        if i < slips:
            true = true @ Pose2(-0.3, 0.0, 0.5)
        odometry.learn(measured, true)
    return odometry


def measured(true):
    return Pose2(true.x * (1.0 + SCALE), 0.0, true.yaw * (1.0 + PER_TURN) + PER_DISTANCE * true.x)


@pytest.mark.parametrize("true", [Pose2(0.3, 0.0, 0.0), Pose2(0.0, 0.0, 0.5), Pose2(0.2, 0.0, -0.3)])
def test_bias_is_learned_and_removed(true):
    corrected = learned().corrected(measured(true))
    assert corrected.x == pytest.approx(true.x, abs=0.002)
    assert corrected.yaw == pytest.approx(true.yaw, abs=0.002)


def test_nothing_is_learned_from_slips():
    corrected = learned(slips=60).corrected(measured(Pose2(0.3, 0.0, 0.0)))
    assert corrected.yaw == pytest.approx(0.0, abs=0.003)


def test_the_variance_of_random_errors_is_learned_and_never_exceeds_the_settings():
    motion, settings = Pose2(0.3, 0.0, 0.0), OdometryErrorModel(MapperSettings())
    nominal = settings.nominal_variance(motion)
    np.testing.assert_allclose(settings.variance(motion), nominal)
    assert 0.002 < np.sqrt(learned(noise=0.006).variance(motion)[2]) < 0.02
    assert (learned(noise=0.25).variance(motion) <= nominal).all()


def test_without_data_odometry_is_not_corrected():
    motion = Pose2(0.3, 0.01, -0.1)
    assert OdometryErrorModel(MapperSettings()).corrected(motion) == motion


def test_a_half_turn_across_the_wrap_is_no_error():
    odometry = OdometryErrorModel(MapperSettings())
    for _ in range(20):
        odometry.learn(Pose2(0.3, 0.0, np.pi - 0.01), Pose2(0.3, 0.0, -np.pi + 0.01))
    assert odometry.corrected(Pose2(0.3, 0.0, 0.5)).yaw == pytest.approx(0.5, abs=0.02)
