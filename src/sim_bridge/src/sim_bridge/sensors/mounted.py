"""A sensor mounted on a robot: measures when it is due, and delivers its reading after its delay."""

import math
from collections import deque
from typing import Any, Deque, Optional, Tuple

from sim_bridge.config import SimulationSettings
from sim_bridge.sensors.base import Reading, Schedule, Sensor, SensorContext


class MountedSensor:
    """Measures with a sensor on its schedule.

    Args:
        sensor: The sensor.
        settings: Rates of the simulation.
    """

    def __init__(self, sensor: Sensor[Any], settings: SimulationSettings):
        self._sensor = sensor
        self._is_enabled = not sensor.on_demand
        self._reading: Optional[Reading] = None
        self._delayed: Deque[Tuple[int, Reading]] = deque()
        self._schedule = Schedule(1)
        self.retime(settings)

    def retime(self, settings: SimulationSettings) -> None:
        """Adapt the schedule to new rates; steps are counted from 0 again."""
        self._schedule = self._sensor.schedule(settings)
        self._delayed.clear()

    def enable(self, is_enabled: bool) -> None:
        """Enable or disable a sensor that measures on demand; others are always enabled."""
        self._is_enabled = is_enabled or not self._sensor.on_demand

    @property
    def steps_at_once(self) -> int:
        """Physics steps that may be taken at once: ``end_step`` has an effect only after multiples of it."""
        return math.gcd(math.gcd(self._schedule.interval, self._schedule.offset), self._schedule.delay)

    def end_step(self, step: int, context: SensorContext) -> int:
        """Measure if the sensor is due, and release readings whose delay is over.

        Args:
            step: Number of the physics step that has just ended.
            context: State of the robot and of the world.

        Returns:
            Number of the next step after which this method has to be called.
        """
        interval, offset, delay = self._schedule
        since_due = (step - offset) % interval
        if self._is_enabled and not since_due:
            value = self._sensor.measure(context)
            if value is not None and not delay:
                self._reading = Reading(context.stamp, value)
            elif value is not None:
                self._delayed.append((step + delay, Reading(context.stamp, value)))
        while self._delayed and self._delayed[0][0] <= step:
            _, self._reading = self._delayed.popleft()
        due = step + interval - since_due
        return min(due, self._delayed[0][0]) if self._delayed else due

    def pop_reading(self) -> Optional[Reading]:
        """Return the latest reading since the last call; None if there is none."""
        reading, self._reading = self._reading, None
        return reading
