"""Faults that can be put between nodes which are not ours: those of scans, of odometry and of commands."""

from typing import Callable, List, Optional, Sequence, Type

from planar import SettingsError
from sim_bridge.faults.faulty import Faults
from sim_bridge.faults.kind import Fault, FaultKind
from sim_bridge.faults.own import GuardedFault
from sim_bridge.faults.registry import kind_named

# The methods of a kind that change what nodes say to each other.
CHANGES = ("scan", "odometry", "command")
# A time so much less than the last is no correction of the clock: a bag has begun anew, or a simulation.
JUMP_BACK_SECONDS = 1.0


def why_not_relayed(name: str) -> Optional[str]:
    """Why a kind cannot be relayed, in a sentence; None if it can. Raises SettingsError if there is none."""
    if any(_changes(kind_named(name), change) for change in CHANGES):
        return None
    return f"{name} changes no scan, odometry or command, only wheels or the home, which no relay can reach"


class RelayedFaults:
    """The faults on the way between nodes, by a clock that is not ours: ``time`` is what it shows, seconds.

    ``faults``: their times count from ``begin`` on. When the clock has jumped back they begin anew, and those
    added meanwhile are over.
    """

    def __init__(self, faults: Sequence[Fault], seed: int = 0):
        self._anew: Callable[[], Faults] = lambda: Faults(faults, seed)
        self._faults = self._anew()
        self._start: Optional[float] = None
        self._latest = 0.0

    def begin(self, time: float) -> None:
        """The clock is there; until then it is the very beginning."""
        self._start = self._latest = time

    def add(self, kind: str, seconds: float, strength: float, time: float) -> None:
        """Something goes wrong from now on. Raises SettingsError for what cannot be relayed."""
        reason = why_not_relayed(kind)
        if reason is not None:
            raise SettingsError(reason)
        now = self._since_start(time)
        self._faults.add(Fault(kind, now, now + seconds, strength))

    def at(self, time: float, change: str) -> List[FaultKind]:
        """Those that last, and have something to say of what their method ``change`` is for."""
        lasting = self._faults.at(self._since_start(time))
        return [kind for kind in lasting if _changes(_class_of(kind), change)]

    def _since_start(self, time: float) -> float:
        if self._start is None:
            return 0.0
        if time < self._latest - JUMP_BACK_SECONDS:
            self._faults = self._anew()
            self._start, self._latest = min(self._start, time), time
        self._latest = max(self._latest, time)
        return time - self._start


def _changes(kind: Type[FaultKind], change: str) -> bool:
    return getattr(kind, change) is not getattr(FaultKind, change)


def _class_of(kind: FaultKind) -> Type[FaultKind]:
    return kind.guarded if isinstance(kind, GuardedFault) else type(kind)
