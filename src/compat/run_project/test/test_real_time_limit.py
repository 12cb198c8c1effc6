"""Simulated time passes at most in real time while a project's programs start."""

import pytest

from run_project.real_time_limit import NO_MORE_WINDOWS_SECONDS, RealTimeLimit


def speeds_of(speed, steps):
    """Speeds that are set in STEPS: wall time, whether a program starts, whether a window was opened."""
    found = []
    limit = RealTimeLimit(speed, found.append)
    limit.start(0.0)
    for step in steps:
        limit.update(*step)
    return found


def test_the_speed_is_free_when_the_last_window_is_open():
    steps = [(0.2, True, True), (3.0, True, False), (3.2, False, True), (3.4, False, False)]
    assert speeds_of(0.0, [*steps, (4.1, False, False), (9.0, False, False)]) == [1.0, 0.0]
    assert speeds_of(0.0, steps) == [1.0]


def test_a_program_that_starts_later_limits_it_again():
    assert speeds_of(5.0, [(2.0, False, False), (2.2, True, False), (4.0, False, False)]) == [1.0, 5.0] * 2


@pytest.mark.parametrize("speed", [1.0, 0.5])
def test_a_slower_speed_is_not_changed(speed):
    assert speeds_of(speed, [(0.2, True, True), (9.0, False, False)]) == []


def test_a_program_that_is_started_for_ever_does_not_limit_it_for_ever():
    steps = [(float(now), True, now == 5) for now in range(70)]
    assert speeds_of(0.0, steps) == [1.0, 0.0]
    assert NO_MORE_WINDOWS_SECONDS < 65.0
