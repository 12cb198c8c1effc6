"""A mounted sensor measures when it is due, and its reading is available after its delay."""

import pytest

from sim_bridge.config import SimulationSettings
from sim_bridge.sensors.base import Schedule
from sim_bridge.sensors.mounted import MountedSensor


class Context:
    stamp = 0.0


class Counter:
    """A sensor that counts its measurements."""

    name, frame, on_demand = "counter", "base_link", False

    def __init__(self, schedule):
        self._schedule = schedule
        self.count = 0

    def schedule(self, settings):
        return self._schedule

    def measure(self, context):
        self.count += 1
        return self.count


@pytest.mark.parametrize(
    "schedule", [Schedule(1), Schedule(4), Schedule(4, 3), Schedule(5, 2, 7), Schedule(3, 0, 1)]
)
def test_nothing_happens_before_the_next_step(schedule):
    """Updating a sensor only at its next steps gives the readings of updating it at every step."""
    always, seldom = (MountedSensor(Counter(schedule), SimulationSettings()) for _ in range(2))
    next_step = 0
    for step in range(1, 60):
        always.end_step(step, Context())
        if step >= next_step:
            next_step = seldom.end_step(step, Context())
        assert next_step > step
        assert always.pop_reading() == seldom.pop_reading()


@pytest.mark.parametrize(
    "schedule, at_once",
    [(Schedule(4), 4), (Schedule(20, 8), 4), (Schedule(20, 8, 6), 2), (Schedule(5, 2, 7), 1)],
)
def test_a_sensor_needs_to_be_updated_only_after_a_multiple_of_some_steps(schedule, at_once):
    mounted = MountedSensor(Counter(schedule), SimulationSettings())
    assert mounted.steps_at_once == at_once
    assert not any(mounted.end_step(step, Context()) % at_once for step in range(0, 60, at_once))
