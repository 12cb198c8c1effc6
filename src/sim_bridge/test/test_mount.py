"""A sensor on its robot is asked when it is due and heard when its delay is over."""

import pytest

from sim_bridge.config import SimulationSettings
from sim_bridge.sensors.base import Schedule
from sim_bridge.sensors.mount import Mount


class Around:
    stamp = 0.0


class Counter:
    """Tells how often it has been asked."""

    name, frame, on_demand = "counter", "base_link", False

    def __init__(self, schedule):
        self._schedule = schedule
        self.asked = 0

    def schedule(self, settings):
        return self._schedule

    def measure(self, around):
        self.asked += 1
        return self.asked


@pytest.mark.parametrize(
    "schedule", [Schedule(1), Schedule(4), Schedule(4, 3), Schedule(5, 2, 7), Schedule(3, 0, 1)]
)
def test_nothing_happens_before_the_next_step(schedule):
    """A robot that asks its mounts only at their next steps hears what one hears that asks at every step."""
    always, seldom = (Mount(Counter(schedule), SimulationSettings()) for _ in range(2))
    next_step = 0
    for step in range(1, 60):
        always.end_step(step, Around())
        if step >= next_step:
            next_step = seldom.end_step(step, Around())
        assert next_step > step
        assert always.take() == seldom.take()


@pytest.mark.parametrize(
    "schedule, at_once",
    [(Schedule(4), 4), (Schedule(20, 8), 4), (Schedule(20, 8, 6), 2), (Schedule(5, 2, 7), 1)],
)
def test_a_mount_needs_to_be_asked_only_after_a_multiple_of_some_steps(schedule, at_once):
    mount = Mount(Counter(schedule), SimulationSettings())
    assert mount.steps_at_once == at_once
    assert not any(mount.end_step(step, Around()) % at_once for step in range(0, 60, at_once))
