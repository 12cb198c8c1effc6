"""A sensor on its robot: asked when it is due, heard when its delay is over."""

import math
from collections import deque
from typing import Any, Deque, Optional, Tuple

from sim_bridge.config import SimulationSettings
from sim_bridge.sensors.base import Reading, Schedule, Sensor, Surroundings


class Mount:
    """Keeps the schedule of a sensor."""

    def __init__(self, sensor: Sensor[Any], settings: SimulationSettings):
        self._sensor = sensor
        self._is_wanted = not sensor.on_demand
        self._fresh: Optional[Reading] = None
        self._on_their_way: Deque[Tuple[int, Reading]] = deque()
        self._schedule = Schedule(1)
        self.retime(settings)

    def retime(self, settings: SimulationSettings) -> None:
        """The rates have changed, and steps are counted anew."""
        self._schedule = self._sensor.schedule(settings)
        self._on_their_way.clear()

    def want(self, is_wanted: bool) -> None:
        """Whether a sensor that measures on demand is to do so from now on; others always do."""
        self._is_wanted = is_wanted or not self._sensor.on_demand

    @property
    def steps_at_once(self) -> int:
        """There is nothing to do here but after a multiple of so many steps of physics."""
        return math.gcd(math.gcd(self._schedule.interval, self._schedule.offset), self._schedule.delay)

    def end_step(self, step: int, around: Surroundings) -> int:
        """After the step of physics number ``step``; returns the next at which there is something to do."""
        interval, offset, delay = self._schedule
        since_due = (step - offset) % interval
        if self._is_wanted and not since_due:
            value = self._sensor.measure(around)
            if value is not None and not delay:
                self._fresh = Reading(around.stamp, value)
            elif value is not None:
                self._on_their_way.append((step + delay, Reading(around.stamp, value)))
        while self._on_their_way and self._on_their_way[0][0] <= step:
            _, self._fresh = self._on_their_way.popleft()
        due = step + interval - since_due
        return min(due, self._on_their_way[0][0]) if self._on_their_way else due

    def take(self) -> Optional[Reading]:
        """The latest that has come since the last call, if any."""
        reading, self._fresh = self._fresh, None
        return reading
