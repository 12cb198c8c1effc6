"""How fast simulated time may pass: in step with the wall clock, and with the nodes that work on its data."""

from collections import deque
from typing import Deque, Dict, FrozenSet, Iterable, List, Optional, Set

REAL_TIME = 1.0
# Wall seconds of delay that are not made up for.
FORGIVEN_DELAY = 0.2
# Wall seconds after which to ask again while a node is behind.
RECHECK = 0.05
# Simulated seconds between two reports that are taken for a node's period, and how many are remembered.
LONGEST_PERIOD = 1.0
GAPS_KEPT = 10


class Pacer:
    """Says when the next step of a simulation may be taken.

    ``speed`` times as fast as the wall clock, 0 for no such limit; may be changed. The nodes of ``wait_for``
    report how far they have come; simulated time never passes more than one of a node's periods ahead of it.
    The period is the longest of the latest times between two of its reports, not less than
    ``shortest_period`` seconds. A node that keeps all others waiting for ``patience`` wall seconds is given
    up as missing until its reports tell its period anew and it has caught up: one that lags behind for good,
    as who waits for odometry that is dead, would keep them waiting again and again.
    ``odometry_delay``: simulated seconds that a scan may have to wait for odometry; they are granted besides.
    While a node is missing, as all are at the start, the simulation goes on at most in real time.
    """

    def __init__(
        self, speed: float, wait_for: Iterable[str] = (), shortest_period: float = 0.1, patience: float = 5.0
    ):
        self.speed = speed
        self.wait_for = frozenset(wait_for)
        self.odometry_delay = 0.0
        # Nodes that are in step by moments, which are waited for there.
        self.synchronised_nodes: FrozenSet[str] = frozenset()
        self._shortest_period = shortest_period
        self._patience = patience
        self._missing: Set[str] = set(self.wait_for)
        self._given_up: Set[str] = set()
        self._next_stamp = 0.0
        self._reached: Dict[str, float] = {}
        self._gaps: Dict[str, Deque[float]] = {}
        self._blocked_since: Optional[float] = None
        self._anchor_wall = self._anchor_stamp = 0.0
        self._anchor_speed = -1.0

    def report(self, name: str, stamp: float) -> None:
        """A node has worked up to the simulated time ``stamp``."""
        if name not in self.wait_for:
            return
        gap = stamp - self._reached.get(name, stamp)
        self._reached[name] = stamp
        if 0.0 < gap <= LONGEST_PERIOD:
            self._gaps.setdefault(name, deque(maxlen=GAPS_KEPT)).append(gap)
            if name not in self._given_up or stamp >= self._next_stamp - LONGEST_PERIOD:
                self._missing.discard(name)
                self._given_up.discard(name)

    def is_missing(self, name: str) -> bool:
        return name in self._missing - self.synchronised_nodes

    def restart(self) -> None:
        """Time begins anew: what the nodes have reported is void."""
        self._reached.clear()
        self._gaps.clear()
        self._missing = set(self.wait_for)
        self._given_up.clear()
        self._blocked_since = None
        self._anchor_speed = -1.0

    def delay(self, stamp: float, wall: float, is_limited: bool = True) -> float:
        """Wall seconds to wait before asking again; 0 if the step to the time ``stamp`` may be taken.

        Unless ``is_limited``, only the nodes are waited for.
        """
        self._next_stamp = stamp
        if self.lagging_nodes(stamp):
            if self._blocked_since is None:
                self._blocked_since = wall
            return RECHECK
        self._blocked_since = None
        return self._delay_of_speed(stamp, wall) if is_limited else 0.0

    def lagging_nodes(self, stamp: float) -> List[str]:
        """The nodes that a step to ``stamp`` has to wait for."""
        return sorted(
            name
            for name, reached in self._reached.items()
            if name not in self._missing | self.synchronised_nodes
            and reached < stamp - self.period_of(name) - 1e-6
        )

    def period_of(self, name: str) -> float:
        """How far, in simulated seconds, time may pass ahead of a node."""
        return max(self._shortest_period, *self._gaps.get(name, (0.0,))) + self.odometry_delay

    def give_up(self, stamp: float, wall: float) -> List[str]:
        """The nodes that have been waited for too long; from now on they are missing."""
        if self._blocked_since is None or wall - self._blocked_since < self._patience:
            return []
        given_up = self.lagging_nodes(stamp)
        self._missing.update(given_up)
        self._given_up.update(given_up)
        for name in given_up:
            self._gaps.pop(name, None)
        self._blocked_since = None
        return given_up

    def _delay_of_speed(self, stamp: float, wall: float) -> float:
        speed = self.speed
        if self._missing - self.synchronised_nodes and not 0.0 < speed < REAL_TIME:
            speed = REAL_TIME
        if speed == 0.0:
            self._anchor_speed = speed
            return 0.0
        due = self._anchor_wall + (stamp - self._anchor_stamp) / speed
        if speed != self._anchor_speed or wall > due + FORGIVEN_DELAY:
            self._anchor_wall, self._anchor_stamp, self._anchor_speed = wall, stamp, speed
            return 0.0
        return max(0.0, due - wall)
