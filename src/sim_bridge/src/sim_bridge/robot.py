"""A simulated robot: drive, sensors and what they measured."""

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
from sim_bridge.driving.drive import BASE_RATE, OmnidirectionalDrive, RampedDrive, WheelDrive
from sim_bridge.physics.engine import Engine
from sim_bridge.physics.kinematics import interval
from sim_bridge.physics.vehicle import Vehicle
from sim_bridge.power.system import POWER_SECONDS, PowerReading, PowerSystem
from sim_bridge.sensors.base import Mounting, Reading, Sensor, SensorSpec
from sim_bridge.sensors.context import RobotSensorContext
from sim_bridge.sensors.kobuki import KobukiReading
from sim_bridge.sensors.mounted import MountedSensor
from sim_bridge.sensors.odometry import Odometer, Odometry
from sim_bridge.sensors.truth import ContactSensor, GroundTruth, TruthReading, WheelEncoders, WheelState
from sim_bridge.views.scene_view import SceneView


@dataclass(frozen=True)
class RobotWrappers:
    """Functions that wrap each sensor and the drive of a robot, e.g. to inject faults.

    Attributes:
        sensor: Takes a sensor before it is mounted; returns it, or a wrapper that meets the same contract.
        drive: Takes the drive; returns it, or a wrapper that meets the same contract.
    """

    sensor: Callable[[Sensor[Any]], Sensor[Any]] = lambda sensor: sensor
    drive: Callable[[WheelDrive], WheelDrive] = lambda drive: drive


@dataclass(frozen=True, eq=False)
class StepResult:
    """Sensor readings and ground truth after a step.

    Attributes:
        stamp: Simulated time since the start [s].
        readings: The readings that sensors delivered since the last step, by sensor name.
        truth: Latest ground truth of pose and velocity.
        odometry: Latest odometry.
        wheels: Latest wheel angles [rad] and speeds [rad/s].
        contacts: Names (``model::link``) of what the robot collided with since the last step.
        scanner: Name of the first range finder; empty if there is none.
        power: Latest state of the power system; None if the robot has none.
    """

    stamp: float
    readings: Mapping[str, Reading]
    truth: TruthReading
    odometry: Odometry
    wheels: WheelState
    contacts: Tuple[str, ...]
    scanner: str = ""
    power: Optional[PowerReading] = None

    @property
    def base_in_world(self) -> Pose2:
        """True pose of the base in the world."""
        return self.truth.base_in_world

    @property
    def twist(self) -> Twist2:
        """True velocity of the base, in the base frame."""
        return self.truth.twist

    @property
    def tilt(self) -> float:
        """Angle between the robot's z axis and the vertical [rad]."""
        return self.truth.tilt

    @property
    def wheel_angles(self) -> Tuple[float, ...]:
        """Angles of the driven wheels, those on the left first [rad]."""
        return self.wheels.angles

    @property
    def wheel_speeds(self) -> Tuple[float, ...]:
        """Speeds of the driven wheels, those on the left first [rad/s]."""
        return self.wheels.speeds

    @property
    def scans(self) -> Tuple[Scan, ...]:
        """New scans of all range finders."""
        return tuple(reading.value for reading in self.readings.values() if isinstance(reading.value, Scan))

    @property
    def scan(self) -> Optional[Scan]:
        """New scan of the first range finder; None if there is none."""
        reading = self.readings.get(self.scanner)
        return reading.value if reading else None

    @property
    def kobuki(self) -> Optional[KobukiReading]:
        """Bumper, cliff and wheel-drop sensors of a Kobuki base, if enabled; None for other robots."""
        reading = self.readings.get("kobuki")
        return reading.value if reading else None


class Robot:
    """A robot in a scene.

    Args:
        engine: The physics engine.
        view: What its sensors see of the scene.
        name: Name of the robot's model.
        profile: Parts, drive and sensors.
        mounting: Start pose, settings and seed.
        wrappers: Wrap its sensors and drive.

    Attributes:
        vehicle: The base and wheels in the engine.
        specs: Specifications of the described sensors, by sensor name.
        steps_at_once: Physics steps between which the robot has nothing to do.
    """

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
        self._view = view
        self.specs: Dict[str, SensorSpec] = {}
        self.reset(mounting)

    def reset(self, mounting: Mounting) -> None:
        """Reset drive, odometry and sensors for a new start.

        Args:
            mounting: Start pose, settings and seed of the new start.
        """
        self._set_rates(mounting.settings)
        self._streams = mounting.streams
        battery = self.profile.battery
        self._power = PowerSystem(battery, mounting.settings) if battery is not None else None
        self._context = RobotSensorContext(self.vehicle, self._view, self._power, mounting.settings)
        self._power_reading = self._context.power
        drive, odometry = self.profile.drive, self.profile.odometry
        self._controller = OmnidirectionalDrive(drive) if drive.is_omnidirectional else RampedDrive(drive)
        self._drive = self._wrappers.drive(self._controller)
        self._context.refresh(0.0)
        truth, wheels, contacts = GroundTruth(), WheelEncoders(), ContactSensor()
        self._odometer = Odometer(odometry, odometry.build(drive, mounting))
        self._latest: Dict[str, Any] = {
            truth.name: truth.measure(self._context),
            self._odometer.name: Odometry(),
            wheels.name: wheels.measure(self._context),
            contacts.name: (),
        }
        self._mounts: Dict[str, MountedSensor] = {}
        # No sensor is due before this physics step.
        self._next_step = 0
        for sensor in (truth, self._odometer, wheels, contacts):
            self._mount(self._wrappers.sensor(sensor))
        self.specs = {
            self._mount(self._wrappers.sensor(sensor)): spec
            for spec, sensor in _built(self.profile.sensors, mounting)
        }
        self._count_steps()

    def command(self, twist: Twist2) -> None:
        """Set the velocity command.

        Args:
            twist: Speed [m/s] and turn rate [rad/s]; holds until the drive's time-out.
        """
        self._drive.command(twist)

    def halt(self) -> None:
        """Stop at once and discard the command."""
        self._drive.halt()

    def park(self) -> None:
        """Hold the odometry until ``wake``, while the robot is not moved."""
        self._odometer.hold(True)

    def wake(self, step: int) -> None:
        """Undo ``park``; the noise of the sensors starts afresh.

        Args:
            step: Number of physics steps since the rates were set.
        """
        self._odometer.hold(False)
        self._streams.restart(step)

    @property
    def power_interval(self) -> int:
        """Physics steps between two updates of the battery."""
        return self._power_interval

    def switch_motors(self, on: bool) -> None:
        """Switch motor power; without it, or with an empty battery, commands are ignored."""
        self._drive.switch(on and not (self._power is not None and self._power.is_empty))

    def reset_odometry(self) -> None:
        """Reset the odometry to the origin of its frame."""
        self._odometer.reset()

    def retime(self, settings: SimulationSettings) -> None:
        """Change the physics rate or the rates of sensors.

        Args:
            settings: The new rates; the noise stays that of the last reset.
        """
        self._set_rates(settings)
        self._next_step = 0
        for mount in self._mounts.values():
            mount.retime(settings)
        self._count_steps()

    def _set_rates(self, settings: SimulationSettings) -> None:
        """Compute the interval, in physics steps, at which motors are set and contacts read."""
        self._settings = settings
        self._interval = interval(settings.physics_rate, BASE_RATE)
        self._power_interval = self._interval * max(round(POWER_SECONDS * BASE_RATE), 1)
        self.vehicle.invalidate_speeds()

    def _count_steps(self) -> None:
        each = (mount.steps_at_once for mount in self._mounts.values())
        self.steps_at_once = reduce(math.gcd, each, self._interval)

    def enable_sensor(self, name: str, is_enabled: bool = True) -> None:
        """Enable or disable a sensor that measures only on demand, such as a camera.

        Args:
            name: Key of the sensor in ``specs``.
            is_enabled: Whether it measures from now on; a sensor that is not on demand is always enabled.
        """
        self._mounts[name].enable(is_enabled)

    def begin_steps(self, step: int) -> None:
        """Set the motor targets, if due.

        Args:
            step: Number of the physics step that follows.
        """
        if step % self._interval == 0:
            seconds = self._interval / self._settings.physics_rate
            left, right = self._drive.wheel_speeds(seconds)
            if isinstance(self._controller, OmnidirectionalDrive):
                lateral = self._controller.lateral_speed
                self.vehicle.move(Twist2(0.5 * (left + right), 0.5 * (right - left), lateral), seconds)
            else:
                self.vehicle.drive(left, right, seconds)

    def end_steps(self, step: int, stamp: float) -> None:
        """Run the measurements of the sensors that are due.

        Args:
            step: Number of physics steps since the rates were set.
            stamp: Simulated time [s].
        """
        if step % self._interval == 0:
            self._context.record_contacts()
            self.update_power(step, stamp)
        if step < self._next_step:
            return
        self._context.refresh(stamp)
        self._next_step = min([mount.end_step(step, self._context) for mount in self._mounts.values()])

    def observe(self, stamp: float) -> StepResult:
        """Return the readings since the last call, and the latest ground truth.

        Args:
            stamp: Simulated time of the result [s].
        """
        self._context.clear_contacts()
        delivered = {name: mount.pop_reading() for name, mount in self._mounts.items()}
        readings = {name: reading for name, reading in delivered.items() if reading is not None}
        self._latest.update({name: readings[name].value for name in self._latest if name in readings})
        return StepResult(
            stamp,
            readings,
            truth=self._latest[GroundTruth.name],
            odometry=self._latest[Odometer.name],
            wheels=self._latest[WheelEncoders.name],
            contacts=self._latest[ContactSensor.name],
            scanner=self.profile.scanner,
            power=self._power_reading,
        )

    def update_power(self, step: int, stamp: float) -> None:
        """Charge or discharge the battery, if due; the motors of a robot with an empty one stop for good.

        Args:
            step: Number of physics steps since the rates were set.
            stamp: Simulated time [s].
        """
        power = self._power
        if power is None or step % self._power_interval:
            return
        self._context.refresh(stamp)
        seconds = self._power_interval / self._settings.physics_rate
        power.update(seconds, self._context.wheels[0], self._context.is_on_dock())
        self._power_reading = self._context.power
        if power.is_empty:
            self._drive.switch(False)

    def _mount(self, sensor: Sensor[Any]) -> str:
        """Mount a sensor and return its name, with a number appended if the name is taken."""
        name, count = sensor.name, 1
        while name in self._mounts:
            count += 1
            name = f"{sensor.name}_{count}"
        self._mounts[name] = MountedSensor(sensor, self._settings)
        return name


def _built(specs: Sequence[SensorSpec], mounting: Mounting) -> Iterator[Tuple[SensorSpec, Sensor[Any]]]:
    """Yield each specification with its sensor, which knows how many of its kind came before."""
    counts: CounterOf[type] = Counter()
    for spec in specs:
        yield spec, spec.build(replace(mounting, number=counts[type(spec)]))
        counts[type(spec)] += 1


__getattr__ = deprecated_names(__name__, {"Fitting": "RobotWrappers", "Observation": "StepResult"})
