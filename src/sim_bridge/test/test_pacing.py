"""The pace of simulated time."""

import pytest

from sim_bridge.pacing import Pacer


def steps_within(pacer, wall_seconds, step=0.02):
    """Simulated seconds that pass while the wall clock does; checks in small portions of wall time."""
    stamp, wall = 0.0, 0.0
    while wall < wall_seconds:
        while pacer.delay(stamp + step, wall) <= 0.0 and stamp < 1000.0:
            stamp += step
        wall += 0.001
    return stamp


@pytest.mark.parametrize("speed", [0.5, 1.0, 4.0])
def test_simulated_time_passes_at_the_given_speed(speed):
    assert steps_within(Pacer(speed), 2.0) == pytest.approx(2.0 * speed, abs=0.1)


def test_speed_zero_has_no_limit():
    assert steps_within(Pacer(0.0), 0.01) >= 1000.0


def test_a_delay_is_not_caught_up():
    pacer = Pacer(1.0)
    assert pacer.delay(0.02, 0.0) == 0.0
    assert pacer.delay(0.04, 60.0) == 0.0
    assert pacer.delay(0.06, 60.0) == pytest.approx(0.02)


def reported(pacer, name, until, period=0.1):
    """Reports of a node up to a time, one a period."""
    for stamp in (until - 2.0 * period, until - period, until):
        pacer.report(name, stamp)


def test_until_all_nodes_have_reported_time_passes_as_on_the_wall():
    pacer = Pacer(0.0, ["amcl", "move_base"])
    reported(pacer, "amcl", 0.0)
    reported(pacer, "other_node", 0.0)
    assert pacer.is_missing("move_base")
    assert not pacer.is_missing("amcl")
    assert pacer.delay(0.02, 0.0) == 0.0
    assert pacer.delay(0.06, 0.0) > 0.0


def test_a_further_node_is_waited_for_once_it_reports_and_until_then_time_passes_as_on_the_wall():
    pacer = Pacer(0.0)
    pacer.follow("laser")
    assert pacer.delay(0.02, 0.0) == 0.0
    assert pacer.delay(0.06, 0.0) > 0.0, "it has never answered"
    reported(pacer, "laser", 5.0)
    assert pacer.delay(5.1, 0.0) == 0.0
    assert pacer.lagging_nodes(5.12) == ["laser"]


def test_beside_a_node_of_the_wall_clock_time_passes_as_on_the_wall():
    pacer = Pacer(0.0)
    pacer.limited_by = frozenset({"driver"})
    assert steps_within(pacer, 2.0) == pytest.approx(2.0, abs=0.1)
    pacer.limited_by = frozenset()
    assert steps_within(pacer, 0.01) >= 1000.0


def test_a_node_whose_scan_waits_for_slow_odometry_is_not_waited_for():
    pacer = Pacer(0.0, ["amcl"])
    reported(pacer, "amcl", 0.985, period=0.025)
    assert pacer.lagging_nodes(1.1) == ["amcl"]
    pacer.odometry_delay = 0.08
    assert pacer.lagging_nodes(1.1) == []


def test_in_lock_step_the_slowest_node_sets_the_pace():
    pacer = Pacer(0.0, ["amcl", "move_base"])
    reported(pacer, "amcl", 5.0)
    reported(pacer, "move_base", 1.0)
    assert pacer.delay(1.1, 0.0) == 0.0
    assert pacer.delay(1.12, 0.0) > 0.0
    assert pacer.lagging_nodes(1.12) == ["move_base"]
    pacer.report("move_base", 1.1)
    assert pacer.delay(1.12, 0.0) == 0.0


@pytest.mark.parametrize(("period", "ahead"), [(0.02, 0.1), (0.1, 0.1), (0.2, 0.2), (0.5, 0.5)])
def test_time_passes_one_of_a_nodes_own_periods_ahead_of_it(period, ahead):
    pacer = Pacer(0.0, ["move_base"])
    reported(pacer, "move_base", 3.0, period)
    assert pacer.delay(3.0 + ahead, 0.0) == 0.0
    assert pacer.delay(3.0 + ahead + 0.01, 0.0) > 0.0


def test_a_node_that_becomes_slower_is_waited_for_again_at_its_new_pace():
    pacer = Pacer(0.0, ["move_base"], patience=5.0)
    reported(pacer, "move_base", 1.0, 0.1)
    assert pacer.delay(1.2, 0.0) > 0.0
    assert pacer.give_up(1.2, 5.1) == ["move_base"]
    reported(pacer, "move_base", 2.0, 0.4)
    assert not pacer.is_missing("move_base")
    assert pacer.delay(2.4, 6.0) == 0.0
    assert pacer.delay(2.42, 6.0) > 0.0


def test_a_pause_between_two_reports_is_no_period():
    pacer = Pacer(0.0, ["amcl"])
    pacer.report("amcl", 0.0)
    pacer.report("amcl", 20.0)
    assert pacer.is_missing("amcl")


def test_a_node_that_falls_silent_is_given_up_once_until_it_reports_again():
    pacer = Pacer(0.0, ["amcl"], patience=5.0)
    reported(pacer, "amcl", 1.0)
    assert pacer.delay(2.0, 10.0) > 0.0
    assert pacer.give_up(2.0, 14.0) == []
    assert pacer.give_up(2.0, 15.1) == ["amcl"]
    assert pacer.delay(2.0, 15.2) == 0.0
    assert pacer.give_up(2.02, 99.0) == []
    reported(pacer, "amcl", 2.0)
    assert not pacer.is_missing("amcl")


def test_a_node_that_can_never_catch_up_does_not_slow_time_down():
    """As amcl without odometry, which skips a scan when a hundred others have come: 10 s later."""
    pacer, stamp, wall, given_up = Pacer(0.0, ["amcl"], patience=5.0), 0.0, 0.0, 0
    reported(pacer, "amcl", 0.0)
    while wall < 60.0:
        while pacer.delay(stamp + 0.02, wall) <= 0.0:
            stamp += 0.02
            if stamp > 20.0 and round(stamp / 0.02) % 5 == 0:
                pacer.report("amcl", stamp - 10.0)
            elif stamp < 10.0:
                pacer.report("amcl", stamp)
        given_up += len(pacer.give_up(stamp + 0.02, wall))
        wall += 0.01
    assert given_up == 1
    assert stamp > 45.0
    reported(pacer, "amcl", stamp)
    assert not pacer.is_missing("amcl")
