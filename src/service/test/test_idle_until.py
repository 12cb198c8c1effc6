"""Idle time of the service's robot, and when the service has to be called again."""

import math

import pytest
from service_bench import NOW, Bench

from service.idle import idle_until


@pytest.mark.parametrize(
    ("is_moving", "due", "until"),
    [
        (False, (50.0, 40.0), 40.0),
        (False, (math.inf, 3600.0), 3600.0),
        (False, (12.9,), 10.0),
        (True, (50.0,), 10.0),
    ],
)
def test_the_robot_is_idle_until_what_is_due_first(is_moving, due, until):
    assert idle_until(10.0, is_moving, *due) == until


def test_the_next_plan_is_due_a_period_after_the_last_one_however_often_one_asks():
    bench = Bench()
    start = {"unix_millis_earliest_start_time": round(1000.0 * (NOW + 7200.0))}
    bench.send("go desk", **start)
    bench.tick()
    due = bench.service.wakes_at(bench.now)
    assert due == pytest.approx(bench.now + 60.0)
    bench.tick(20.0)
    assert bench.service.wakes_at(bench.now) == due
    bench.tick(40.0)
    assert bench.service.wakes_at(bench.now) == pytest.approx(due + 60.0)
