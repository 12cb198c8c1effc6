"""Faults of messages between external nodes: those of scans, odometry and commands."""

from typing import Callable, List, Optional, Sequence, Type

from planar import SettingsError
from planar.extensions import class_of
from sim_bridge.faults.injection import FaultInjector
from sim_bridge.faults.kind import Fault, FaultKind
from sim_bridge.faults.registry import kind_named

# The methods of a kind that change messages.
MESSAGE_METHODS = ("scan", "odometry", "command")
# A clock that goes back farther was not corrected but reset: a bag or a simulation has started again.
JUMP_BACK_SECONDS = 1.0


def unsupported_by_relay(name: str) -> Optional[str]:
    """Return why a kind of fault cannot be relayed; None if it can.

    Raises:
        SettingsError: There is no such kind.
    """
    if any(_overrides(kind_named(name), method) for method in MESSAGE_METHODS):
        return None
    return f"{name} changes no scan, odometry or command, only wheels or the home, which no relay can reach"


class RelayedFaults:
    """Faults of relayed messages, timed by an external clock.

    Times of faults count from ``begin``. When the clock jumps back, they start again from there, and faults
    that were added meanwhile are removed.

    Args:
        faults: Faults of the whole run.
        seed: Seed of their random numbers.
    """

    def __init__(self, faults: Sequence[Fault], seed: int = 0):
        self._make_injector: Callable[[], FaultInjector] = lambda: FaultInjector(faults, seed)
        self._injector = self._make_injector()
        self._start: Optional[float] = None
        self._latest = 0.0

    def begin(self, time: float) -> None:
        """Start to count the time of faults.

        Args:
            time: First time of the external clock [s]; before this call, 0 s have passed.
        """
        self._start = self._latest = time

    def add(self, kind: str, seconds: float, strength: float, time: float) -> None:
        """Add a fault that starts now.

        Args:
            kind: Name of the kind.
            seconds: Duration [s].
            strength: In the unit of the kind.
            time: Time of the external clock [s].

        Raises:
            SettingsError: There is no such kind, or it changes no message.
        """
        reason = unsupported_by_relay(kind)
        if reason is not None:
            raise SettingsError(reason)
        now = self._since_start(time)
        self._injector.add(Fault(kind, now, now + seconds, strength))

    def active(self, time: float, method: str) -> List[FaultKind]:
        """Return the active faults that change one type of message, in the order of adding.

        Args:
            time: Time of the external clock [s].
            method: ``scan``, ``odometry`` or ``command``.
        """
        active = self._injector.active(self._since_start(time))
        return [kind for kind in active if _overrides(class_of(kind), method)]

    def _since_start(self, time: float) -> float:
        if self._start is None:
            return 0.0
        if time < self._latest - JUMP_BACK_SECONDS:
            self._injector = self._make_injector()
            self._start, self._latest = min(self._start, time), time
        self._latest = max(self._latest, time)
        return time - self._start


def _overrides(kind: Type[FaultKind], method: str) -> bool:
    return getattr(kind, method) is not getattr(FaultKind, method)
