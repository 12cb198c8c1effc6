"""A robot in its scene: it is commanded, it moves, it measures."""

import math
from collections import Counter
from dataclasses import dataclass, replace
from functools import reduce
from typing import Any, Callable, Dict, Iterator, Mapping, Optional, Sequence, Tuple
from typing import Counter as CounterOf

from planar import Pose2, Scan, Twist2
from planar.deprecation import deprecated_names
from sim_bridge.config import SimulationSettings
from sim_bridge.description import RobotProfile
from sim_bridge.description.bodies import bodies_of
from sim_bridge.driving.drive import BASE_RATE, RampedDrive, WheelDrive
from sim_bridge.physics.engine import Engine
from sim_bridge.physics.vehicle import Vehicle
from sim_bridge.sensors.base import Mounting, Reading, Sensor, SensorSpec
from sim_bridge.sensors.context import RobotSensorContext
from sim_bridge.sensors.kobuki import KobukiReading
from sim_bridge.sensors.mounted import MountedSensor
from sim_bridge.sensors.odometry import Odometer, Odometry
from sim_bridge.sensors.truth import ContactSensor, GroundTruth, TruthReading, WheelEncoders, WheelState
from sim_bridge.views.scene_view import SceneView


@dataclass(frozen=True)
class RobotWrappers:
    """What is put before the sensors and the drive of a robot: each function gets one and gives one back."""

    sensor: Callable[[Sensor[Any]], Sensor[Any]] = lambda sensor: sensor
    drive: Callable[[WheelDrive], WheelDrive] = lambda drive: drive


@dataclass(frozen=True, eq=False)
class StepResult:
    """What there is to know after a step.

    ``stamp``: simulated seconds since the start. ``readings``: what each sensor has told since the last step,
    by its name; ``scanner`` is that of the first range finder. The rest is the latest of what every robot
    tells. ``contacts``: names (``model::link``) of what the robot has bumped into since the last step.
    """

    stamp: float
    readings: Mapping[str, Reading]
    truth: TruthReading
    odometry: Odometry
    wheels: WheelState
    contacts: Tuple[str, ...]
    scanner: str = ""

    @property
    def base_in_world(self) -> Pose2:
        """The truth."""
        return self.truth.base_in_world

    @property
    def twist(self) -> Twist2:
        """The truth."""
        return self.truth.twist

    @property
    def tilt(self) -> float:
        """Between the robot's axis and the vertical, rad."""
        return self.truth.tilt

    @property
    def wheel_angles(self) -> Tuple[float, ...]:
        """Of the driven wheels, those on the left first, rad."""
        return self.wheels.angles

    @property
    def wheel_speeds(self) -> Tuple[float, ...]:
        """Of the driven wheels, those on the left first, rad/s."""
        return self.wheels.speeds

    @property
    def scans(self) -> Tuple[Scan, ...]:
        """Of all range finders that were due."""
        return tuple(told.value for told in self.readings.values() if isinstance(told.value, Scan))

    @property
    def scan(self) -> Optional[Scan]:
        """Of the first range finder, None if it was not due."""
        told = self.readings.get(self.scanner)
        return told.value if told else None

    @property
    def kobuki(self) -> Optional[KobukiReading]:
        """What a Kobuki base feels, if that is wanted; None of other robots."""
        told = self.readings.get("kobuki")
        return told.value if told else None


class Robot:
    """The robot ``name``, mounted as ``mounting`` says; ``fitting`` puts wrappers before what it has."""

    def __init__(
        self,
        engine: Engine,
        view: SceneView,
        name: str,
        profile: RobotProfile,
        mounting: Mounting,
        wrappers: RobotWrappers = RobotWrappers(),
    ):
        self.name = name
        self.profile = profile
        self._wrappers = wrappers
        parts, drive = bodies_of(profile.model, name), profile.drive
        self.vehicle = Vehicle(
            engine, name, *parts, len(drive.left_joints), drive.torque, mounting.base_in_space
        )
        self._context = RobotSensorContext(self.vehicle, view)
        # What its description has, by the names that they tell by.
        self.specs: Dict[str, SensorSpec] = {}
        self.begin(mounting)

    def begin(self, mounting: Mounting) -> None:
        """It stands where it starts: nothing has been commanded, driven or measured yet."""
        self._time(mounting.settings)
        drive, odometry = self.profile.drive, self.profile.odometry
        self._drive = self._wrappers.drive(RampedDrive(drive))
        self._context.refresh(0.0)
        self._context.clear_contacts()
        truth, wheels, contacts = GroundTruth(), WheelEncoders(), ContactSensor()
        self._odometer = Odometer(odometry, odometry.odometry_model(drive, mounting))
        self._latest: Dict[str, Any] = {
            truth.name: truth.measure(self._context),
            self._odometer.name: Odometry(),
            wheels.name: wheels.measure(self._context),
            contacts.name: (),
        }
        self._mounts: Dict[str, MountedSensor] = {}
        # Before this step of physics nothing is due.
        self._next_step = 0
        for sensor in (truth, self._odometer, wheels, contacts):
            self._mount(self._wrappers.sensor(sensor))
        self.specs = {
            self._mount(self._wrappers.sensor(sensor)): spec
            for spec, sensor in _built(self.profile.sensors, mounting)
        }
        self._count_steps()

    def command(self, twist: Twist2) -> None:
        """A new command; it holds until its time-out."""
        self._drive.command(twist)

    def halt(self) -> None:
        """Stands still at once, as if switched on anew."""
        self._drive.halt()

    def switch_motors(self, on: bool) -> None:
        self._drive.switch(on)

    def reset_odometry(self) -> None:
        self._odometer.reset()

    def retime(self, settings: SimulationSettings) -> None:
        """The rates have changed."""
        self._time(settings)
        self._next_step = 0
        for mount in self._mounts.values():
            mount.retime(settings)
        self._count_steps()

    def _time(self, settings: SimulationSettings) -> None:
        """Motors are set, and bumps are felt, at each interval of so many steps of physics."""
        self._settings = settings
        self._interval = max(settings.physics_rate // BASE_RATE, 1)
        self.vehicle.invalidate_speeds()

    def _count_steps(self) -> None:
        # There is nothing to do here but after a multiple of so many steps of physics.
        each = (mount.steps_at_once for mount in self._mounts.values())
        self.steps_at_once = reduce(math.gcd, each, self._interval)

    def want(self, name: str, is_wanted: bool = True) -> None:
        """A sensor that measures only on demand is to do so from now on, or no longer."""
        self._mounts[name].enable(is_wanted)

    def begin_steps(self, step: int) -> None:
        """Before the step of physics number ``step``: sets the motors if it is time to."""
        if step % self._interval == 0:
            seconds = self._interval / self._settings.physics_rate
            self.vehicle.drive(*self._drive.wheel_speeds(seconds))

    def end_steps(self, step: int, stamp: float) -> None:
        """At the time ``stamp``, when ``step`` steps of physics are over: what is due measures."""
        if step % self._interval == 0:
            self._context.record_contacts()
        if step < self._next_step:
            return
        self._context.refresh(stamp)
        self._next_step = min([mount.end_step(step, self._context) for mount in self._mounts.values()])

    def observe(self, stamp: float) -> StepResult:
        """What has been measured since the last call."""
        self._context.clear_contacts()
        told = {name: mount.pop_reading() for name, mount in self._mounts.items()}
        readings = {name: reading for name, reading in told.items() if reading is not None}
        self._latest.update({name: readings[name].value for name in self._latest if name in readings})
        return StepResult(
            stamp,
            readings,
            truth=self._latest[GroundTruth.name],
            odometry=self._latest[Odometer.name],
            wheels=self._latest[WheelEncoders.name],
            contacts=self._latest[ContactSensor.name],
            scanner=self.profile.scanner,
        )

    def _mount(self, sensor: Sensor[Any]) -> str:
        """Returns the name that the sensor has here: those of the same name get numbers behind it."""
        name, count = sensor.name, 1
        while name in self._mounts:
            count += 1
            name = f"{sensor.name}_{count}"
        self._mounts[name] = MountedSensor(sensor, self._settings)
        return name


def _built(specs: Sequence[SensorSpec], mounting: Mounting) -> Iterator[Tuple[SensorSpec, Sensor[Any]]]:
    """Specs and their sensors; each knows how many of its kind came before."""
    counts: CounterOf[type] = Counter()
    for spec in specs:
        yield spec, spec.build(replace(mounting, number=counts[type(spec)]))
        counts[type(spec)] += 1


__getattr__ = deprecated_names(__name__, {"Fitting": "RobotWrappers", "Observation": "StepResult"})
