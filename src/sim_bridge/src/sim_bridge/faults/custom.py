"""User-defined kinds of faults: checked against the contract when loaded, guarded while active."""

import math
from typing import Any, Callable, Optional, Tuple, Type

import numpy as np

from planar import Scan, Twist2
from planar.plugins import PluginContract, PluginError, errors_raised_as, load_plugin
from sim_bridge.errors import FaultError
from sim_bridge.faults.kind import FaultContext, FaultKind
from sim_bridge.sensors.odometry import Odometry

CONTRACT = PluginContract("fault", FaultKind, None, "sim_bridge.faults")


def load_custom_kind(name: str) -> Optional[Type[FaultKind]]:
    """Load a user-defined kind of fault.

    Args:
        name: Dotted name (``my_package.my_module/MyFault``) or entry point.

    Returns:
        The class; None if there is none of that name.

    Raises:
        PluginError: It does not meet the contract.
    """
    found: Any = load_plugin(name, CONTRACT)
    if found is None:
        return None
    if not issubclass(found, FaultKind):
        raise PluginError(f"{name} is no fault: it is not derived from {FaultKind.__module__}.FaultKind")
    try:
        default, least, largest = map(float, found.strength)
        is_valid = least <= default <= largest
    except (TypeError, ValueError):
        is_valid = False
    if not is_valid:
        raise PluginError(
            f"{name} is no fault: strength must be (default, least, largest), got {found.strength!r}"
        )
    return found


class GuardedFault(FaultKind):
    """Calls a user-defined fault and checks what it returns; its failures become a FaultError.

    Args:
        name: Name of the kind, for errors.
        kind: Class of the fault.
        strength: In the unit of the kind.
        rng: Random generator of the fault.

    Attributes:
        guarded: Class of the fault.

    Raises:
        FaultError: The fault cannot be instantiated; its methods raise it as well.
    """

    def __init__(self, name: str, kind: Type[FaultKind], strength: float, rng: np.random.Generator):
        self._name, self.guarded = name, kind
        self._fault = self._call(kind, strength, rng)

    def scan(self, scan: Scan) -> Optional[Scan]:
        return self._checked("scan", Scan, self._call(self._fault.scan, scan))

    def odometry(self, odometry: Odometry) -> Optional[Odometry]:
        return self._checked("odometry", Odometry, self._call(self._fault.odometry, odometry))

    def command(self, twist: Twist2) -> Optional[Twist2]:
        return self._checked("command", Twist2, self._call(self._fault.command, twist))

    def wheel_speeds(self, left: float, right: float) -> Tuple[float, float]:
        returned = self._call(self._fault.wheel_speeds, left, right)
        try:
            speeds = float(returned[0]), float(returned[1])
        except (TypeError, ValueError, IndexError):
            speeds = math.nan, math.nan
        if not all(map(math.isfinite, speeds)):
            raise FaultError(f"{self._name}: wheel_speeds returned {returned!r}, expected two finite numbers")
        return speeds

    def begin(self, context: FaultContext) -> None:
        self._call(self._fault.begin, context)

    def end(self, context: FaultContext) -> None:
        self._call(self._fault.end, context)

    def _call(self, method: Callable[..., Any], *arguments: Any) -> Any:
        with errors_raised_as(self._name, FaultError):
            return method(*arguments)

    def _checked(self, method: str, expected: type, returned: Any) -> Any:
        if returned is not None and not isinstance(returned, expected):
            got = type(returned).__name__
            raise FaultError(f"{self._name}: {method} returned {got}, expected {expected.__name__} or None")
        return returned
