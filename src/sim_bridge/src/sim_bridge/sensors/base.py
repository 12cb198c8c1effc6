"""Contract of a sensor: when it measures, in which frame, what, and with which errors.

A robot's description has a *spec* of each sensor, its settings (such as ``LaserProfile``). When the robot is
put into a scene, ``spec.build(mounting)`` makes the sensor with its noise and random generator. From then on
``schedule`` states after which physics steps it is due; each time it is due and enabled, ``measure(context)``
is called once. A wrapper that meets the contract can replace a sensor: see SensorWrapper.
"""

from dataclasses import dataclass, field
from typing import Any, Generic, List, NamedTuple, Optional, Protocol, Sequence, Tuple, TypeVar

import numpy as np

from planar import Pose2, Twist2
from planar.deprecation import deprecated_names
from sim_bridge.config import SimulationSettings
from sim_bridge.physics.collision_queries import Contact
from sim_bridge.physics.kinematics import KinematicState
from sim_bridge.power.system import PowerReading

Value = TypeVar("Value")
Measurement = TypeVar("Measurement", covariant=True)
# Streams of random numbers below this belong to odometry and range finders.
FIRST_OTHER_STREAM = 100
# Part of the seeds of generators that start afresh.
RESTART = 7_000_001

__getattr__ = deprecated_names(__name__, {"Surroundings": "SensorContext"})


class Schedule(NamedTuple):
    """When a sensor measures, in physics steps.

    Attributes:
        interval: Steps between two measurements.
        offset: Number of the first step after which it measures.
        delay: Steps from a measurement until its reading is available.
    """

    interval: int
    offset: int = 0
    delay: int = 0


class Reading(NamedTuple):
    """A measurement with its time.

    Attributes:
        stamp: Time of the measurement [simulated s].
        value: The measurement, of the sensor's type, such as a Scan.
    """

    stamp: float
    value: Any


class SensorContext(Protocol):
    """State of a robot and of the world around it at the end of a physics step, as sensors measure it."""

    @property
    def stamp(self) -> float:
        """Time since the start [simulated s]."""

    @property
    def base(self) -> KinematicState:
        """Pose and velocity of the robot's base frame in the world."""

    @property
    def twist(self) -> Twist2:
        """Velocity of the base frame along its x axis [m/s] and turn rate [rad/s]."""

    @property
    def wheels(self) -> Tuple[Tuple[float, ...], Tuple[float, ...]]:
        """Angles [rad] and speeds [rad/s] of the driven wheels, left ones first."""

    @property
    def bumps(self) -> Sequence[Contact]:
        """Contacts of the robot since the last odometry period, one for each link that it touched."""

    @property
    def gravity(self) -> float:
        """Downward acceleration [m/s^2]."""

    def floors_below(self, points: Sequence[Sequence[float]]) -> List[float]:
        """Return the height of the floor below each of several points.

        Args:
            points: Points (N, 3) in the world [m].

        Returns:
            The heights (N,) [m]; -inf where there is no floor.
        """

    def section(self, height: float) -> Tuple[np.ndarray, np.ndarray]:
        """Return the horizontal cross-section of all but the robot.

        Args:
            height: Height above the world's origin [m].

        Returns:
            Segments (N, 4) as x, y, x, y in the world [m], and the laser_retro (N,) of each.
        """

    def cast_rays(
        self, origin: np.ndarray, directions: np.ndarray, max_range: float
    ) -> Tuple[np.ndarray, np.ndarray]:
        """Cast rays at all but the robot.

        Args:
            origin: Start (3,) of the rays in the world [m].
            directions: Unit vectors (N, 3) in the world.
            max_range: Largest range [m].

        Returns:
            The length (N,) of each ray, infinite without a hit [m], and the laser_retro (N,) of what it hits.
        """

    def docks(self) -> List[Pose2]:
        """Return the poses of all docks in the world."""

    @property
    def power(self) -> Optional[PowerReading]:
        """State of the robot's power system; None if it has none."""

    def triangles(self) -> Tuple[np.ndarray, np.ndarray]:
        """Return the surfaces of all but the robot.

        Returns:
            Triangles (T, 3, 3) in the world [m], and their shaded colours (T, 3), uint8.
        """


class Sensor(Protocol[Measurement]):
    """A sensor of a robot."""

    @property
    def name(self) -> str:
        """Key of its readings in ``StepResult.readings``."""

    @property
    def frame(self) -> str:
        """Frame of its measurements."""

    @property
    def on_demand(self) -> bool:
        """Whether it measures only while it is enabled, because a measurement is expensive."""

    def schedule(self, settings: SimulationSettings) -> Schedule:
        """Return when it measures.

        Args:
            settings: Rates of the simulation.
        """

    def measure(self, context: SensorContext) -> Optional[Measurement]:
        """Measure.

        Args:
            context: State of the robot and of the world.

        Returns:
            The measurement; None for no reading.
        """


class SensorWrapper(Generic[Value]):
    """Forwards every call to a sensor; a subclass overrides what it changes.

    Args:
        sensor: The wrapped sensor.
    """

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

    def measure(self, context: SensorContext) -> Optional[Value]:
        return self._sensor.measure(context)


class NoiseStreams:
    """Random generators of a robot's sensors, which start afresh after an idle time."""

    def __init__(self) -> None:
        self._generators: List[Tuple[List[int], np.random.Generator]] = []

    def make(self, key: List[int]) -> np.random.Generator:
        """Return a new generator.

        Args:
            key: Its seeds.
        """
        generator = np.random.default_rng(key)
        self._generators.append((key, generator))
        return generator

    def restart(self, step: int) -> None:
        """Let all generators start afresh, differently for each step.

        Args:
            step: Number of the physics step.
        """
        for key, generator in self._generators:
            state = np.random.default_rng([*key, RESTART, step]).bit_generator.state
            generator.bit_generator.state = state


@dataclass(frozen=True, eq=False)
class Mounting:
    """Where and how a sensor is mounted.

    Attributes:
        base_in_space: Start pose (4, 4) of the robot's base in the world.
        settings: Rates and noise.
        seed: Seed of the simulation.
        robot: Number of the robot in its scene, from 0.
        number: Number of sensors of the same kind that the robot has before this one.
        streams: Random generators of the robot's sensors.
    """

    base_in_space: np.ndarray
    settings: SimulationSettings
    seed: int
    robot: int = 0
    number: int = 0
    streams: NoiseStreams = field(default_factory=NoiseStreams)

    def rng(self, stream: int) -> np.random.Generator:
        """Return the sensor's random generator.

        Args:
            stream: Number of the kind of sensor, at least 100 from the others. In use are 0 (odometry),
                1 (range finders), 100 (cameras), 200 (inertial sensors) and 300 (object detectors).
        """
        robot = [] if self.robot == 0 and stream < FIRST_OTHER_STREAM else [self.robot]
        return self.streams.make([self.seed, *robot, stream + self.number])


class SensorSpec(Protocol):
    """Settings of a sensor in a robot's description."""

    def build(self, mounting: Mounting) -> Sensor[Any]:
        """Make the sensor.

        Args:
            mounting: Start pose, settings and seed.
        """


def every(rate: Optional[float], settings: SimulationSettings) -> Schedule:
    """Return the schedule of a rate.

    Args:
        rate: Rate [Hz], rounded so that the period is a whole number of odometry periods; None for that of
            odometry.
        settings: Rates of the simulation.
    """
    periods = 1 if rate is None else max(round(settings.odometry_rate / rate), 1)
    return Schedule(periods * (settings.physics_rate // settings.odometry_rate))
