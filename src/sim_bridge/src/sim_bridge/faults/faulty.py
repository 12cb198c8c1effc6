"""Faults put before a robot: wrappers round its sensors and its drive, and what happens to its home."""

from typing import Any, Iterable, List, Optional, Sequence, Tuple, TypeVar

import numpy as np

from planar import Scan, Twist2
from sim_bridge.driving.drive import WheelDrive
from sim_bridge.faults.kind import Fault, FaultKind, Stage
from sim_bridge.faults.registry import fault_named
from sim_bridge.robot import RobotWrappers
from sim_bridge.sensors.base import Sensor, SensorWrapper, Surroundings
from sim_bridge.sensors.odometry import Odometry

_STREAM = 900
T = TypeVar("T")


class Faults:
    """The faults of a run: ``fitting`` for its robot, and ``disturb`` to be called at each step.

    ``may_come``: whether more may be added once the robot has been fitted.
    """

    def __init__(self, faults: Sequence[Fault], seed: int = 0, may_come: bool = False):
        self._seed, self._may_come = seed, may_come
        self._pairs: List[Tuple[Fault, FaultKind]] = []
        self._begun: List[FaultKind] = []
        for fault in faults:
            self.add(fault)

    def add(self, fault: Fault) -> None:
        """One more."""
        rng = np.random.default_rng([self._seed, _STREAM, fault.seed, len(self._pairs)])
        self._pairs.append((fault, fault_named(fault.kind, fault.strength, rng)))

    @property
    def wrappers(self) -> RobotWrappers:
        """What stands before the sensors and the drive of the robot."""
        if not (self._pairs or self._may_come):
            return RobotWrappers()
        return RobotWrappers(
            sensor=lambda sensor: FaultySensor(sensor, self), drive=lambda drive: FaultyDrive(drive, self)
        )

    def at(self, now: float) -> List[FaultKind]:
        """Those that last at a time, in order."""
        return [kind for fault, kind in self._pairs if fault.start <= now < fault.end]

    def disturb(self, now: float, stage: Stage) -> None:
        """Lets the faults of the home and of beliefs begin and end."""
        lasting = self.at(now)
        for kind in lasting:
            if kind not in self._begun:
                self._begun.append(kind)
                kind.begin(stage)
        for kind in [each for each in self._begun if each not in lasting]:
            self._begun.remove(kind)
            kind.end(stage)


def through(kinds: Iterable[FaultKind], change: str, value: T) -> Optional[T]:
    """What faults make of a value, one after the other; None: nothing.

    ``change``: the method that does it, ``scan``, ``odometry`` or ``command``.
    """
    told: Optional[T] = value
    for kind in kinds:
        if told is not None:
            told = getattr(kind, change)(told)
    return told


class FaultySensor(SensorWrapper[Any]):
    """Changes scans and odometry; other sensors are as they were."""

    def __init__(self, sensor: Sensor[Any], faults: Faults):
        super().__init__(sensor)
        self._faults = faults

    def measure(self, around: Surroundings) -> Any:
        told, kinds = super().measure(around), self._faults.at(around.stamp)
        if isinstance(told, Scan):
            return through(kinds, "scan", told)
        if isinstance(told, Odometry):
            return through(kinds, "odometry", told)
        return told


class FaultyDrive:
    """Changes commands, and what the wheels make of them."""

    def __init__(self, drive: WheelDrive, faults: Faults):
        self._drive, self._faults = drive, faults
        self._now = 0.0
        self.switch, self.halt = drive.switch, drive.halt

    def command(self, twist: Twist2) -> None:
        heard = through(self._faults.at(self._now), "command", twist)
        if heard is not None:
            self._drive.command(heard)

    def wheel_speeds(self, seconds: float) -> Tuple[float, float]:
        self._now += seconds
        left, right = self._drive.wheel_speeds(seconds)
        for kind in self._faults.at(self._now):
            left, right = kind.wheel_speeds(left, right)
        return left, right
