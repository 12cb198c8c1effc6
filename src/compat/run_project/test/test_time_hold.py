"""Simulated time stands still while a project's programs start, and stops where a script's sleep ends."""

import math

import pytest

from run_project.time_hold import NO_MORE_WINDOWS_SECONDS, TimeHold


class Held:
    """A hold of a simulation, and the times at which it had to stop."""

    def __init__(self, speed=0.0):
        self.now, self.times = 0.0, []
        self.hold = TimeHold(speed, lambda: self.now, self.times.append)
        self.hold.start(0.0)

    def update(self, *steps):
        """Report STEPS: wall time, whether a program starts, whether a window was opened."""
        for step in steps:
            self.hold.update(*step)


STARTED = ((0.2, True, True), (3.0, True, False), (3.1, False, True), (3.2, False, False))


def test_time_passes_when_the_last_window_is_open():
    held = Held()
    held.update(*STARTED)
    assert held.times == [0.0]
    held.update((4.1, False, False), (9.0, False, False))
    assert held.times == [0.0, math.inf]


def test_a_program_that_starts_later_holds_the_time_at_which_it_is_seen():
    held = Held()
    held.update((2.0, False, False))
    held.now = 7.5
    held.update((2.2, True, False))
    held.now = 7.6
    held.update((2.4, True, False), (4.0, False, False))
    assert held.times == [0.0, math.inf, 7.5, math.inf]


def test_time_stops_where_the_next_sleep_ends_until_what_follows_has_started():
    held = Held()
    for end in (5.0, 3.0):
        held.hold.begin_sleep(end)
    assert held.times == [0.0], "programs still start"
    held.update((1.0, False, False))
    held.now = 3.0
    held.hold.end_sleep(3.0, 1.2)
    held.update((1.3, True, True), (2.0, False, False))
    assert held.times == [0.0, 3.0, 5.0]
    assert not held.hold.is_starting


@pytest.mark.parametrize("speed", [1.0, 0.5])
def test_time_is_not_held_at_the_speed_of_the_authors(speed):
    held = Held(speed)
    held.update(*STARTED)
    assert (held.times, held.hold.is_starting) == ([], False)


def test_a_program_that_is_started_for_ever_does_not_hold_it_for_ever():
    held = Held()
    held.update(*((float(now), True, now == 5) for now in range(70)))
    assert held.times == [0.0, math.inf]
    assert NO_MORE_WINDOWS_SECONDS < 65.0
