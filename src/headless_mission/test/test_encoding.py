"""Values with the precision of messages."""

import numpy as np
import pytest

from headless_mission.encoding import ExactValues, MessageValues
from planar import OccupancyGrid, Pose2, Scan

SCAN = Scan(0.1, -0.3, 0.1, np.ones(4, np.float32), 0.05, 10.1)


def test_limits_of_scans_and_maps_are_those_of_float32():
    scan = MessageValues().scan(SCAN)
    assert scan.angle_increment == float(np.float32(0.1)) != 0.1
    assert scan.range_max == float(np.float32(10.1))
    assert scan.ranges is SCAN.ranges
    assert MessageValues().grid(OccupancyGrid(np.zeros((2, 2), np.int8), 0.05)).resolution == float(
        np.float32(0.05)
    )


@pytest.mark.parametrize("yaw", [0.0, 0.3, -2.9, 3.1])
def test_a_heading_stays_the_same_but_for_its_last_bits(yaw):
    pose = MessageValues().pose(Pose2(1.0, 2.0, yaw))
    assert (pose.x, pose.y) == (1.0, 2.0)
    assert pose.yaw == pytest.approx(yaw, abs=1e-15)


def test_exact_values_are_passed_on():
    assert ExactValues().scan(SCAN) is SCAN
