"""People whom a robot meets: where they were, and who ran into whom."""

import math
from typing import List, Sequence, Tuple

import numpy as np

from planar import Pose2, Twist2
from sim_bridge import Simulation, StepResult

# m/s towards a person below which a robot runs into nobody.
STANDING_SPEED = 0.05


class PedestrianContacts:
    """Told of each step. ``people_at_fault``: the names of those who did, each once."""

    def __init__(self, simulation: Simulation):
        self._crowd = simulation.scene.crowd
        self._before: Tuple[Pose2, Twist2] = (Pose2(), Twist2())
        self._track: List[np.ndarray] = []
        self.people_at_fault: List[str] = []

    def robot_collisions(self, observation: StepResult) -> Sequence[str]:
        """What the robot has bumped into, without the people who ran into it."""
        people = [name for name in observation.contacts if name in self._crowd.links]
        theirs = {name for name in people if not self._is_robot_at_fault(name)}
        self.people_at_fault += sorted(theirs - set(self.people_at_fault))
        self._before = (observation.base_in_world, observation.twist)
        return [name for name in observation.contacts if name not in theirs]

    def record(self) -> None:
        """Where everybody is now."""
        self._track.append(self._crowd.rows.copy())

    @property
    def track(self) -> np.ndarray:
        """(T, N, 5) at each time noted: x, y, velocity by x and y, radius of each."""
        return np.array(self._track)

    def _is_robot_at_fault(self, name: str) -> bool:
        """Whether it came on faster than the person did, as both moved before they touched."""
        robot, twist = self._before
        x, y, v_x, v_y, _ = self._crowd.rows[self._crowd.links.index(name)].tolist()
        distance = max(math.hypot(x - robot.x, y - robot.y), 1e-9)
        to_x, to_y = (x - robot.x) / distance, (y - robot.y) / distance
        robots = twist.v * (math.cos(robot.yaw) * to_x + math.sin(robot.yaw) * to_y)
        persons = -(v_x * to_x + v_y * to_y)
        return robots > STANDING_SPEED and robots >= persons
