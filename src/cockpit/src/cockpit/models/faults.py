"""Faults requested on the page: their kinds, and which of them are active."""

import math
from dataclasses import dataclass
from typing import List, Optional, Tuple

Row = Tuple[str, str, str]


@dataclass(frozen=True)
class FaultKindInfo:
    """A kind of fault of the simulator.

    Attributes:
        name: Name in scenario files and of the service.
        description: What the fault does, without a full stop.
        unit: Unit of the strength; empty if the kind has no strength.
        usual: Default strength.
        least: Smallest strength.
        largest: Largest strength.
    """

    name: str
    description: str
    unit: str
    usual: float
    least: float
    largest: float

    def sentence(self) -> str:
        """Describe the fault and the range of its strength."""
        if not self.unit:
            return f"{self.description}."
        return f"{self.description}. Usually {self.amount(0.0)}, from {self.least:g} to {self.largest:g}."

    def amount(self, strength: float) -> str:
        """Format a strength with its unit; 0 is the default strength."""
        return f"{strength or self.usual:g} {self.unit}" if self.unit else ""


@dataclass(frozen=True)
class FaultRequest:
    """A requested fault.

    Attributes:
        kind: Kind of the fault.
        seconds: Duration [simulated s]; 0 means forever.
        strength: Strength in the unit of the kind; 0 means the usual one.
    """

    kind: FaultKindInfo
    seconds: float
    strength: float


class RequestedFaults:
    """The faults that one simulator has accepted."""

    def __init__(self) -> None:
        self._simulator: Optional[str] = None
        self._begun: List[Tuple[FaultRequest, float]] = []

    def set_simulator(self, simulator: Optional[str]) -> None:
        """Set the address of the simulator's service; the list is cleared when it changes."""
        if simulator != self._simulator:
            self._begun.clear()
        self._simulator = simulator

    def add(self, request: FaultRequest, now: float) -> None:
        """Record a fault.

        Args:
            request: The fault.
            now: Time at which it began [simulated s].
        """
        self._begun.append((request, now))

    def rows(self, now: float) -> List[Row]:
        """Return kind, strength and seconds left of each active fault.

        Expired faults are kept: when simulated time jumps back, the simulator applies them again.

        Args:
            now: Simulated time [s].
        """
        active = (
            (request, start + (request.seconds or math.inf)) for request, start in self._begun if start <= now
        )
        return [_row(request, end - now) for request, end in active if now < end]


def _row(request: FaultRequest, left: float) -> Row:
    return (
        request.kind.name,
        request.kind.amount(request.strength),
        "forever" if math.isinf(left) else f"{round(left, 1):g}",
    )
