"""Drawn motions have the means and spreads of the book's formulas (and of amcl's mistakes)."""

import math

import numpy as np
import pytest

from amcl_lite.config import LocalizerSettings
from amcl_lite.motion.motion_model import moved, rotations_and_translation
from planar import Pose2, wrap

COUNT = 40_000
# Four standard errors of a mean, and of a standard deviation, of COUNT draws.
MEAN_TOLERANCE, SPREAD_TOLERANCE = 4.0 / math.sqrt(COUNT), 4.0 / math.sqrt(2.0 * COUNT)


def drawn(model, before, now, start=Pose2(), **alphas):
    settings = LocalizerSettings(motion_model=model, **alphas)
    poses = np.tile(start.as_array(), (COUNT, 1))
    return moved(poses, before, now, settings, np.random.default_rng(1))


def assert_distribution(values, mean, spread):
    assert abs(values.mean() - mean) <= MEAN_TOLERANCE * spread + 1e-12
    assert abs(values.std() - spread) <= SPREAD_TOLERANCE * spread + 1e-12


def test_a_motion_is_a_turn_a_way_and_a_turn():
    parts = rotations_and_translation(Pose2(0.0, 0.0, 0.5), Pose2(0.0, 2.0, 1.0))
    assert parts == pytest.approx((math.pi / 2 - 0.5, 2.0, 1.0 - math.pi / 2))


def test_turning_on_the_spot_is_one_turn():
    assert rotations_and_translation(Pose2(), Pose2(0.005, -0.005, 1.0)) == pytest.approx(
        (0, 0.00707, 1), abs=1e-4
    )


def test_particles_without_noise_follow_the_odometry_from_where_they_are():
    nothing = dict.fromkeys(
        (
            "rotation_from_rotation",
            "rotation_from_translation",
            "translation_from_translation",
            "translation_from_rotation",
            "strafe_from_translation",
        ),
        0.0,
    )
    before, now = Pose2(3.0, 1.0, 2.0), Pose2(3.5, 0.0, -1.0)
    start = Pose2(-1.0, 4.0, 0.7)
    expected = start @ (before.inverse() @ now)
    for model in ("diff", "omni", "diff-corrected", "omni-corrected"):
        end = Pose2.from_array(drawn(model, before, now, start, **nothing)[0])
        assert end.distance_to(expected) < 1e-12 and abs(wrap(end.yaw - expected.yaw)) < 1e-12, model


@pytest.mark.parametrize("model, power", [("diff", 1.0), ("diff-corrected", 0.5)])
def test_driving_straight_spreads_along_the_way_and_in_heading(model, power):
    poses = drawn(model, Pose2(), Pose2(0.8, 0.0, 0.0), rotation_from_translation=1e-4)
    assert_distribution(poses[:, 0], 0.8, (0.2 * 0.8**2) ** power)
    assert_distribution(poses[:, 2], 0.0, math.sqrt(2.0) * (1e-4 * 0.8**2) ** power)


@pytest.mark.parametrize("model, power", [("diff", 1.0), ("diff-corrected", 0.5)])
def test_turning_spreads_the_heading_by_alpha_1(model, power):
    poses = drawn(model, Pose2(), Pose2(0.0, 0.0, 1.2))
    assert_distribution(poses[:, 2], 1.2, (0.2 * 1.2**2) ** power)


def test_driving_backwards_is_as_good_as_driving_forwards():
    forwards = drawn("diff", Pose2(), Pose2(0.8, 0.0, 0.0))
    backwards = drawn("diff", Pose2(), Pose2(-0.8, 0.0, 0.0))
    assert backwards[:, 0].mean() == pytest.approx(-0.8, abs=0.01)
    assert backwards.std(axis=0) == pytest.approx(forwards.std(axis=0), rel=0.05)


def test_omni_corrected_spreads_as_in_the_book_and_omni_as_in_amcl():
    alphas = {
        "rotation_from_rotation": 0.1,
        "rotation_from_translation": 0.2,
        "translation_from_translation": 0.3,
        "translation_from_rotation": 0.4,
        "strafe_from_translation": 0.5,
    }
    way, turn = 0.6, 0.3
    right = drawn("omni-corrected", Pose2(), Pose2(way, 0.0, turn), **alphas)
    assert_distribution(right[:, 0], way, math.sqrt(0.3 * way**2 + 0.4 * turn**2))
    assert_distribution(right[:, 1], 0.0, math.sqrt(0.4 * turn**2 + 0.5 * way**2))
    assert_distribution(right[:, 2], turn, math.sqrt(0.1 * turn**2 + 0.2 * way**2))
    amcls = drawn("omni", Pose2(), Pose2(way, 0.0, turn), **alphas)
    assert_distribution(amcls[:, 0], way, 0.3 * way**2 + 0.1 * turn**2)
    assert_distribution(amcls[:, 1], 0.0, 0.1 * turn**2 + 0.5 * way**2)
    assert_distribution(amcls[:, 2], turn, 0.4 * turn**2 + 0.2 * way**2)
