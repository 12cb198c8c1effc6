"""Fault injection into a simulated robot: wrappers of its sensors and drive, changes of its environment."""

from typing import Any, Iterable, List, Optional, Sequence, Tuple, TypeVar

import numpy as np

from planar import Scan, Twist2
from sim_bridge.driving.drive import WheelDrive
from sim_bridge.faults.kind import Fault, FaultContext, FaultKind
from sim_bridge.faults.registry import make_fault
from sim_bridge.robot import RobotWrappers
from sim_bridge.sensors.base import Sensor, SensorContext, SensorWrapper
from sim_bridge.sensors.odometry import Odometry

_STREAM = 900
T = TypeVar("T")


class FaultInjector:
    """Injects the faults of a run.

    Hand ``wrappers`` to the simulation when the robot is built, and call ``update`` after each step.

    Args:
        faults: Faults known from the start.
        seed: Seed of the run; each fault derives its random numbers from it.
        extendable: Whether faults may be added after the robot has been built.

    Attributes:
        now: Simulated time of the last update [s].
    """

    def __init__(self, faults: Sequence[Fault], seed: int = 0, extendable: bool = False):
        self._seed, self._extendable = seed, extendable
        self.now = 0.0
        self._faults: List[Tuple[Fault, FaultKind]] = []
        self._begun: List[FaultKind] = []
        for fault in faults:
            self.add(fault)

    def add(self, fault: Fault) -> None:
        """Add a fault.

        Raises:
            SettingsError: There is no such kind.
        """
        rng = np.random.default_rng([self._seed, _STREAM, fault.seed, len(self._faults)])
        self._faults.append((fault, make_fault(fault.kind, fault.strength, rng)))

    @property
    def wrappers(self) -> RobotWrappers:
        """Wrappers of the robot's sensors and drive."""
        if not (self._faults or self._extendable):
            return RobotWrappers()
        return RobotWrappers(
            sensor=lambda sensor: FaultySensor(sensor, self), drive=lambda drive: FaultyDrive(drive, self)
        )

    def active(self, now: float) -> List[FaultKind]:
        """Return the faults that are active at a simulated time [s], in the order of adding."""
        return [kind for fault, kind in self._faults if fault.start <= now < fault.end]

    def are_inactive(self, start: float, end: float) -> bool:
        """Return whether no fault is active at any time between two simulated times [s]."""
        return all(fault.start > end or fault.end <= start for fault, _ in self._faults)

    def update(self, now: float, context: FaultContext) -> None:
        """Begin and end the faults of the environment that are due.

        Args:
            now: Simulated time [s].
            context: What the faults may change, with the present pose of the robot.
        """
        self.now, active = now, self.active(now)
        for kind in active:
            if kind not in self._begun:
                self._begun.append(kind)
                kind.begin(context)
        for kind in [each for each in self._begun if each not in active]:
            self._begun.remove(kind)
            kind.end(context)


def apply_faults(kinds: Iterable[FaultKind], method: str, value: T) -> Optional[T]:
    """Pass a value through faults, one after the other.

    Args:
        kinds: The faults.
        method: Their method to call: ``scan``, ``odometry`` or ``command``.
        value: What would be published without them.

    Returns:
        The value to publish; None for none.
    """
    changed: Optional[T] = value
    for kind in kinds:
        if changed is not None:
            changed = getattr(kind, method)(changed)
    return changed


class FaultySensor(SensorWrapper[Any]):
    """Applies faults to scans and odometry, and passes other readings on."""

    def __init__(self, sensor: Sensor[Any], injector: FaultInjector):
        super().__init__(sensor)
        self._injector = injector

    def measure(self, context: SensorContext) -> Any:
        value, kinds = super().measure(context), self._injector.active(context.stamp)
        if isinstance(value, Scan):
            return apply_faults(kinds, "scan", value)
        if isinstance(value, Odometry):
            return apply_faults(kinds, "odometry", value)
        return value


class FaultyDrive:
    """Applies faults to velocity commands and wheel speeds."""

    def __init__(self, drive: WheelDrive, injector: FaultInjector):
        self._drive, self._injector = drive, injector
        self._now = 0.0
        self.switch, self.halt = drive.switch, drive.halt

    def command(self, twist: Twist2) -> None:
        received = apply_faults(self._injector.active(self._now), "command", twist)
        if received is not None:
            self._drive.command(received)

    def wheel_speeds(self, seconds: float) -> Tuple[float, float]:
        self._now = max(self._now + seconds, self._injector.now)  # a parked robot's drive is not advanced
        left, right = self._drive.wheel_speeds(seconds)
        for kind in self._injector.active(self._now):
            left, right = kind.wheel_speeds(left, right)
        return left, right
