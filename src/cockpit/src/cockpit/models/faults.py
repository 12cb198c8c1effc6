"""Faults that are asked for at the page: what their kinds are, and which of them last."""

import math
from dataclasses import dataclass
from typing import List, Optional, Tuple

Row = Tuple[str, str, str]


@dataclass(frozen=True)
class Kind:
    """``says``: what goes wrong; ``unit``: of its strength, empty if it has none.

    ``usual``, ``least``, ``largest``: strengths.
    """

    name: str
    says: str
    unit: str
    usual: float
    least: float
    largest: float

    def sentence(self) -> str:
        """What goes wrong, and how much it can."""
        if not self.unit:
            return f"{self.says}."
        return f"{self.says}. Usually {self.amount(0.0)}, from {self.least:g} to {self.largest:g}."

    def amount(self, strength: float) -> str:
        """As a person reads it; 0: the usual one."""
        return f"{strength or self.usual:g} {self.unit}" if self.unit else ""


@dataclass(frozen=True)
class Wish:
    """A fault as it is asked for; ``seconds``: 0 for ever, ``strength``: 0 the usual one."""

    kind: Kind
    seconds: float
    strength: float


class Asked:
    """What one simulator has been asked for, and has let go wrong."""

    def __init__(self) -> None:
        self._simulator: Optional[str] = None
        self._begun: List[Tuple[Wish, float]] = []

    def know(self, simulator: Optional[str]) -> None:
        """Which one there is: another one, or none, has nothing of what was asked for before."""
        if simulator != self._simulator:
            self._begun.clear()
        self._simulator = simulator

    def add(self, wish: Wish, now: float) -> None:
        """``now``: simulated seconds."""
        self._begun.append((wish, now))

    def rows(self, now: float) -> List[Row]:
        """Kind, strength and seconds left of each that lasts.

        Nothing is over for good: where time is set back, the simulator lets it go wrong once more.
        """
        lasting = ((wish, start + (wish.seconds or math.inf)) for wish, start in self._begun if start <= now)
        return [_row(wish, end - now) for wish, end in lasting if now < end]


def _row(wish: Wish, left: float) -> Row:
    return (
        wish.kind.name,
        wish.kind.amount(wish.strength),
        "for ever" if math.isinf(left) else f"{round(left, 1):g}",
    )
