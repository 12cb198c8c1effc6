"""A series of samples stays small, however long it becomes."""

import numpy as np

from evaluation.consumers.samples import Samples


def sampled(seconds, most, rate=50.0):
    """What is kept of a pose that comes ``rate`` times a second."""
    samples = Samples(2, most)
    largest = 0
    for number in range(int(seconds * rate)):
        stamp = number / rate
        if samples.is_due(stamp):
            samples.add(stamp, 2.0 * stamp)
        largest = max(largest, len(samples.rows()))
    return samples.rows(), largest


def test_a_short_series_keeps_ten_samples_a_second():
    rows, _ = sampled(10.0, most=100)
    assert np.allclose(rows[:, 0], np.arange(100) / 10.0)
    assert np.allclose(rows[:, 1], 2.0 * rows[:, 0])


def test_a_long_series_is_thinned_evenly():
    rows, largest = sampled(130.0, most=100)
    assert largest <= 100
    assert rows[0, 0] == 0.0 and rows[-1, 0] > 127.0
    steps = np.diff(rows[:, 0])
    assert np.ptp(steps) < 0.05
    assert np.isclose(np.median(steps), 1.6)


def test_a_series_may_be_empty():
    assert Samples(4).rows().shape == (0, 4)
