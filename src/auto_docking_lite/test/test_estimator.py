"""The estimate of a dock's pose from signals that are received in passing."""

import math

import numpy as np
import pytest

from auto_docking_lite.config import DockingSettings
from auto_docking_lite.estimator import DockEstimator
from planar import Pose2, Twist2, wrap
from planar.geometry.dock_field import DockField

PERIOD, PER_TICK = 0.02, 5
# Error of the expected pose [m, m, rad].
PRIOR_ERROR = Pose2(0.08, -0.09, 0.02)


def passing():
    """Yield poses of a robot in the dock's frame which passes the dock, turns and approaches it."""
    base = Pose2(-0.1, -1.5, math.radians(60.0))
    for twist, seconds in (
        (Twist2(0.6, 0.0), 2.6),
        (Twist2(0.0, 1.5), 1.6),
        (Twist2(0.2, 0.0), 1.0),
    ):
        for _ in range(round(seconds / PERIOD)):
            base = base @ Pose2(twist.v * PERIOD, 0.0, twist.omega * PERIOD)
            yield base


@pytest.mark.parametrize("seed", range(20))
def test_the_estimate_is_as_good_as_it_claims_whatever_the_particles(seed):
    field = DockField()
    estimator = DockEstimator(DockingSettings(), np.random.default_rng(seed))
    estimator.expect(PRIOR_ERROR)
    received = [(base, field.signals(base)) for base in passing()]
    for first in range(0, len(received), PER_TICK):
        estimator.update(received[first : first + PER_TICK])
    found = estimator.estimate()
    error = found.dock_in_odom
    assert math.hypot(error.x, error.y) < 4.0 * found.position_deviation
    assert abs(wrap(error.yaw)) < 4.0 * found.yaw_deviation
    assert found.position_deviation < 0.12
