"""Contacts between the robot and pedestrians, and who is at fault."""

import math
from typing import List, Sequence, Tuple

import numpy as np

from planar import Pose2, Twist2
from sim_bridge import Simulation, StepResult

# Speed towards a person below which the robot is not at fault [m/s].
STANDING_SPEED = 0.05


class PedestrianContacts:
    """Attributes contacts to the robot or to pedestrians, and records their tracks; call it at each step.

    Args:
        simulation: Simulation with the pedestrians.

    Attributes:
        people_at_fault: Names of pedestrians that walked into the robot, each once.
    """

    def __init__(self, simulation: Simulation):
        self._crowd = simulation.scene.crowd
        self._before: Tuple[Pose2, Twist2] = (Pose2(), Twist2())
        self._track: List[np.ndarray] = []
        self.people_at_fault: List[str] = []

    def robot_collisions(self, observation: StepResult) -> Sequence[str]:
        """Return what the robot has collided with, without pedestrians that walked into it."""
        people = [name for name in observation.contacts if name in self._crowd.links]
        others = {name for name in people if not self._is_robot_at_fault(name)}
        self.people_at_fault += sorted(others - set(self.people_at_fault))
        self._before = (observation.base_in_world, observation.twist)
        return [name for name in observation.contacts if name not in others]

    def record(self) -> None:
        """Record the current state of all pedestrians."""
        self._track.append(self._crowd.rows.copy())

    @property
    def track(self) -> np.ndarray:
        """(T, N, 5), x, y, velocity in x and y, radius of N pedestrians at each recorded time."""
        return np.array(self._track)

    def _is_robot_at_fault(self, name: str) -> bool:
        """Whether the robot approached faster than the person, by the velocities before the contact."""
        robot, twist = self._before
        x, y, v_x, v_y, _ = self._crowd.rows[self._crowd.links.index(name)].tolist()
        distance = max(math.hypot(x - robot.x, y - robot.y), 1e-9)
        to_x, to_y = (x - robot.x) / distance, (y - robot.y) / distance
        robots = twist.v * (math.cos(robot.yaw) * to_x + math.sin(robot.yaw) * to_y)
        persons = -(v_x * to_x + v_y * to_y)
        return robots > STANDING_SPEED and robots >= persons
