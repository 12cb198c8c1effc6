"""Parking: the physics of a scene is stopped while nothing moves."""

from typing import Mapping

from sim_bridge.physics.engine import Engine
from sim_bridge.physics.forces import Forces
from sim_bridge.physics.standstill import MAX_HELD_SPEED
from sim_bridge.robot import Robot


class Parking:
    """Whether the physics of a scene is stopped.

    Args:
        engine: The physics engine.
        robots: The robots by name.
        forces: Wrenches and efforts that act for a given time.

    Attributes:
        is_active: Whether physics is stopped.
    """

    def __init__(self, engine: Engine, robots: Mapping[str, Robot], forces: Forces):
        self._engine, self._robots, self._forces = engine, robots, forces
        self.is_active = False

    def begin(self) -> bool:
        """Stop physics, if all robots have stood for a while and physics moves nothing else.

        Returns:
            Whether physics is stopped.
        """
        robots = self._robots.values()
        is_at_rest = all(robot.vehicle.is_held for robot in robots) and not self._forces.are_pending
        if not self.is_active and is_at_rest and not self._engine.is_moving(MAX_HELD_SPEED):
            self.is_active = True
            for robot in robots:
                robot.park()
        return self.is_active

    def end(self, step: int) -> None:
        """Let physics go on; the noise of sensors starts afresh.

        Args:
            step: Number of the physics step.
        """
        if self.is_active:
            self.is_active = False
            for robot in self._robots.values():
                robot.wake(step)

    def next_step(self, step: int, end: int) -> int:
        """Return the next step at which a battery is due.

        Args:
            step: Number of the present step.
            end: Number of the last step.
        """
        every = [robot.power_interval for robot in self._robots.values()]
        return min([end, *(step - step % each + each for each in every)])
