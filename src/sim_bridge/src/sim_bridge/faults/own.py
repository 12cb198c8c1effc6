"""Kinds of faults of other people: held to the contract when they are loaded, watched while they last."""

import math
from typing import Any, Callable, Optional, Tuple, Type

import numpy as np

from planar import Scan, Twist2
from planar.plugins import PluginContract, PluginError, errors_raised_as, load_plugin
from sim_bridge.errors import FaultError
from sim_bridge.faults.kind import FaultKind, Stage
from sim_bridge.sensors.odometry import Odometry

CONTRACT = PluginContract("fault", FaultKind, None, "sim_bridge.faults")


def own_kind(name: str) -> Optional[Type[FaultKind]]:
    """The kind of that dotted name, or of an entry point; None if there is none. Raises PluginError."""
    found: Any = load_plugin(name, CONTRACT)
    if found is None:
        return None
    if not issubclass(found, FaultKind):
        raise PluginError(f"{name} is no fault: it is not derived from {FaultKind.__module__}.FaultKind")
    try:
        usual, least, largest = map(float, found.strength)
        is_strength = least <= usual <= largest
    except (TypeError, ValueError):
        is_strength = False
    if not is_strength:
        raise PluginError(f"{name} is no fault: its strength is not the usual one, the least and the largest")
    return found


class GuardedFault(FaultKind):
    """Stands before one of other people, of the class ``guarded``: what goes wrong in it is a FaultError in
    its name.
    """

    def __init__(self, name: str, kind: Type[FaultKind], strength: float, rng: np.random.Generator):
        self._name, self.guarded = name, kind
        self._kind = self._watched(kind, strength, rng)

    def scan(self, scan: Scan) -> Optional[Scan]:
        return self._checked("scan", Scan, self._watched(self._kind.scan, scan))

    def odometry(self, odometry: Odometry) -> Optional[Odometry]:
        return self._checked("odometry", Odometry, self._watched(self._kind.odometry, odometry))

    def command(self, twist: Twist2) -> Optional[Twist2]:
        return self._checked("command", Twist2, self._watched(self._kind.command, twist))

    def wheel_speeds(self, left: float, right: float) -> Tuple[float, float]:
        told = self._watched(self._kind.wheel_speeds, left, right)
        try:
            speeds = float(told[0]), float(told[1])
        except (TypeError, ValueError, IndexError):
            speeds = math.nan, math.nan
        if not all(map(math.isfinite, speeds)):
            raise FaultError(f"{self._name} gave wheel speeds {told!r}")
        return speeds

    def begin(self, stage: Stage) -> None:
        self._watched(self._kind.begin, stage)

    def end(self, stage: Stage) -> None:
        self._watched(self._kind.end, stage)

    def _watched(self, do: Callable[..., Any], *given: Any) -> Any:
        with errors_raised_as(self._name, FaultError):
            return do(*given)

    def _checked(self, method: str, expected: type, told: Any) -> Any:
        if told is not None and not isinstance(told, expected):
            raise FaultError(f"{self._name} gave a {type(told).__name__} for {method}")
        return told
