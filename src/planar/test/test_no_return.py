import math

import numpy as np

from planar import Scan
from planar.geometry.no_return import NoReturnDetector

BEAMS = np.linspace(-1.2, 1.2, 140)


def test_a_constant_reading_that_means_no_return_is_learned():
    rng, learned = np.random.default_rng(0), NoReturnDetector()
    for _ in range(20):
        seen = rng.uniform(1.0, 45.0, 140)
        learned.add(np.append(seen, rng.normal(51.1, 0.03, 40)).astype(np.float32))
    assert 50.8 < learned.distance < 51.05


def test_walls_are_not_learned_as_no_return():
    learned = NoReturnDetector()
    for step in range(200):
        learned.add((60.0 - 0.2 * step) / np.cos(BEAMS))
    assert learned.distance == math.inf


def test_the_range_of_a_scan_is_limited_to_what_is_a_return():
    learned = NoReturnDetector()
    scan = Scan(0.0, 0.0, 0.1, np.full(300, 51.1), 0.1, 80.0)
    assert learned.limited(scan) is scan
    learned.add(scan.ranges)
    assert not learned.limited(scan).hits.any()
