"""The contract of a sensor: when it measures, in which frame, what it tells, how wrong it is.

A robot's description holds a *spec*, data of the sensor's own (``LaserProfile``). When the robot is put into
a scene, ``spec.build(mounting)`` makes the sensor with its noise and random numbers of its own. From then on
``schedule`` says at the end of which steps of physics it is due; each time that it is, and is wanted,
``measure(around)`` is called once. Whatever keeps the contract can stand before a sensor: see SensorWrapper.
"""

from dataclasses import dataclass
from typing import Any, Generic, List, NamedTuple, Optional, Protocol, Sequence, Tuple, TypeVar

import numpy as np

from planar import Twist2
from sim_bridge.config import SimulationSettings
from sim_bridge.physics.collision_queries import Contact
from sim_bridge.physics.kinematics import KinematicState

Value = TypeVar("Value")
Told = TypeVar("Told", covariant=True)
# Streams of random numbers below this belong to odometry and range finders.
FIRST_OTHER_STREAM = 100


class Schedule(NamedTuple):
    """In steps of physics: a sensor measures at the end of each that is number ``offset`` of ``interval``.

    What it tells is heard ``delay`` steps later.
    """

    interval: int
    offset: int = 0
    delay: int = 0


class Reading(NamedTuple):
    """What a sensor told, and the simulated time, s, at which it was so."""

    stamp: float
    value: Any


class Surroundings(Protocol):
    """What a sensor can perceive of its robot and the world at the end of a step of physics."""

    @property
    def stamp(self) -> float:
        """Simulated seconds since the start."""

    @property
    def base(self) -> KinematicState:
        """How the robot's base frame moves in the world."""

    @property
    def twist(self) -> Twist2:
        """Velocity of the base frame along its own x axis, and turn rate."""

    @property
    def wheels(self) -> Tuple[Tuple[float, ...], Tuple[float, ...]]:
        """Angles, rad, and speeds, rad/s, of the driven wheels, those on the left first."""

    @property
    def bumps(self) -> Sequence[Contact]:
        """Where the robot has touched things since the last period of the odometry, one for each link."""

    @property
    def gravity(self) -> float:
        """Downwards, m/s^2."""

    def floors_below(self, points: Sequence[Sequence[float]]) -> List[float]:
        """The heights of what is below points of the world, -inf where there is nothing."""

    def section(self, height: float) -> Tuple[np.ndarray, np.ndarray]:
        """All but the robot at a height: sides (N, 4) as x, y, x, y, and how brightly they reflect, (N,)."""

    def triangles(self) -> Tuple[np.ndarray, np.ndarray]:
        """Triangles (T, 3, 3) of all but the robot, in the world, and their shades (T, 3), uint8."""


class Sensor(Protocol[Told]):
    """Something on a robot that measures."""

    @property
    def name(self) -> str:
        """By which an observation tells what it measured."""

    @property
    def frame(self) -> str:
        """That its readings are told in."""

    @property
    def on_demand(self) -> bool:
        """Whether it measures only while it is asked to, as it takes long."""

    def schedule(self, settings: SimulationSettings) -> Schedule:
        """When it is due at these rates."""

    def measure(self, around: Surroundings) -> Optional[Told]:
        """What it tells now; None if nothing."""


class SensorWrapper(Generic[Value]):
    """Stands before a sensor and passes everything on; a subclass changes what it is for."""

    def __init__(self, sensor: Sensor[Value]):
        self._sensor = sensor

    @property
    def name(self) -> str:
        return self._sensor.name

    @property
    def frame(self) -> str:
        return self._sensor.frame

    @property
    def on_demand(self) -> bool:
        return self._sensor.on_demand

    def schedule(self, settings: SimulationSettings) -> Schedule:
        return self._sensor.schedule(settings)

    def measure(self, around: Surroundings) -> Optional[Value]:
        return self._sensor.measure(around)


@dataclass(frozen=True, eq=False)
class Mounting:
    """What a sensor learns when it is put on a robot, the one number ``robot`` of its scene.

    ``base_in_space``: (4, 4), where the robot starts. ``number``: how many sensors of its kind came before.
    """

    base_in_space: np.ndarray
    settings: SimulationSettings
    seed: int
    robot: int = 0
    number: int = 0

    def rng(self, stream: int) -> np.random.Generator:
        """The sensor's own random numbers; ``stream``: of its kind, a hundred apart from other kinds'.

        Taken are 0 (odometry), 1 (range finders), 100 (cameras) and 200 (inertial sensors).
        """
        robot = [] if self.robot == 0 and stream < FIRST_OTHER_STREAM else [self.robot]
        return np.random.default_rng([self.seed, *robot, stream + self.number])


class SensorSpec(Protocol):
    """A sensor as a robot's description has it."""

    def build(self, mounting: Mounting) -> Sensor[Any]:
        """The sensor itself."""


def every(rate: Optional[float], settings: SimulationSettings) -> Schedule:
    """``rate`` times a second, as near as whole periods of the odometry come to it; None: each of them."""
    periods = 1 if rate is None else max(round(settings.odometry_rate / rate), 1)
    return Schedule(periods * (settings.physics_rate // settings.odometry_rate))
