"""Pace of simulated time: limited by the wall clock and by the nodes that process its data."""

import math
from collections import deque
from typing import Deque, Dict, FrozenSet, Iterable, List, Optional, Set

REAL_TIME = 1.0
# Delay that is not caught up [wall s].
FORGIVEN_DELAY = 0.2
# Time until the next check while a node is behind [wall s].
RECHECK = 0.05
# Longest gap between two reports that counts as a node's period [simulated s], and how many gaps are kept.
LONGEST_PERIOD = 1.0
GAPS_KEPT = 10


class Pacer:
    """Decides when the next step of a simulation may be taken.

    The nodes of ``wait_for`` report how far they have processed the simulation; simulated time never passes
    more than one period of a node ahead of it. The period is the longest of the latest gaps between two of
    its reports. A node that stops the simulation for ``patience`` is given up as missing until it reports
    again and has caught up: a node that lags for good, e.g. one that waits for dead odometry, would otherwise
    stop the simulation again and again. While a node is missing, as all are at the start, the simulation runs
    at most in real time.

    Args:
        speed: Multiple of real time; 0 for no limit.
        wait_for: Names of the nodes to wait for.
        shortest_period: Least period of a node [simulated s].
        patience: Time after which a node is given up [wall s].

    Attributes:
        speed: As the argument; may be changed.
        odometry_delay: Time that a scan may have to wait for odometry, granted in addition [simulated s].
        synchronised_nodes: Nodes that answer each tick, and are waited for elsewhere.
        limited_by: Nodes beside which the simulation runs at most in real time.
    """

    def __init__(
        self, speed: float, wait_for: Iterable[str] = (), shortest_period: float = 0.1, patience: float = 5.0
    ):
        self.speed = speed
        self.wait_for = frozenset(wait_for)
        self.odometry_delay = 0.0
        self.synchronised_nodes: FrozenSet[str] = frozenset()
        self.limited_by: FrozenSet[str] = frozenset()
        self._shortest_period = shortest_period
        self._patience = patience
        self._missing: Set[str] = set(self.wait_for)
        self._given_up: Set[str] = set()
        self._next_stamp = 0.0
        self._reported: Dict[str, float] = {}
        self._gaps: Dict[str, Deque[float]] = {}
        self._blocked_since: Optional[float] = None
        self._anchor_wall = self._anchor_stamp = 0.0
        self._anchor_speed = -1.0

    @property
    def longest_jump(self) -> float:
        """Longest time that may pass at once [simulated s]; 0 in real time and beside nodes that report."""
        others = self._missing.union(self._reported) - self.synchronised_nodes
        if self.limited_by or others or 0.0 < self.speed <= REAL_TIME:
            return 0.0
        return self.speed * FORGIVEN_DELAY if self.speed else math.inf

    def follow(self, name: str) -> None:
        """Wait for the reports of a further node."""
        if name not in self.wait_for:
            self.wait_for |= {name}
            self._missing.add(name)

    def report(self, name: str, stamp: float) -> None:
        """Record how far a node has processed the simulation.

        Args:
            name: Name of the node; others than those of ``wait_for`` are ignored.
            stamp: Simulated time up to which it has processed the data [s].
        """
        if name not in self.wait_for:
            return
        gap = stamp - self._reported.get(name, stamp)
        self._reported[name] = stamp
        if 0.0 < gap <= LONGEST_PERIOD:
            self._gaps.setdefault(name, deque(maxlen=GAPS_KEPT)).append(gap)
            if name not in self._given_up or stamp >= self._next_stamp - LONGEST_PERIOD:
                self._missing.discard(name)
                self._given_up.discard(name)

    @property
    def reporting(self) -> FrozenSet[str]:
        """Nodes that have reported since simulated time began."""
        return frozenset(self._reported)

    def is_missing(self, name: str) -> bool:
        """Return whether a node has not reported yet, or has been given up."""
        return name in self._missing - self.synchronised_nodes

    def reset(self) -> None:
        """Discard all reports, as simulated time restarts."""
        self._reported.clear()
        self._gaps.clear()
        self._missing = set(self.wait_for)
        self._given_up.clear()
        self._blocked_since = None
        self._anchor_speed = -1.0

    def delay(self, stamp: float, wall: float, is_limited: bool = True) -> float:
        """Return the wall seconds to wait before the next check; 0 if the step may be taken.

        Args:
            stamp: Simulated time after the step [s].
            wall: Wall clock [s].
            is_limited: Whether the speed limits the pace; if not, only nodes are waited for.
        """
        self._next_stamp = stamp
        if self.lagging_nodes(stamp):
            if self._blocked_since is None:
                self._blocked_since = wall
            return RECHECK
        self._blocked_since = None
        return self._speed_delay(stamp, wall) if is_limited else 0.0

    def lagging_nodes(self, stamp: float) -> List[str]:
        """Return the nodes that a step to a simulated time [s] has to wait for."""
        return sorted(
            name
            for name, reported in self._reported.items()
            if name not in self._missing | self.synchronised_nodes
            and reported < stamp - self.period_of(name) - 1e-6
        )

    def period_of(self, name: str) -> float:
        """Return how far time may pass ahead of a node [simulated s]."""
        return max(self._shortest_period, *self._gaps.get(name, (0.0,))) + self.odometry_delay

    def give_up(self, stamp: float, wall: float) -> List[str]:
        """Mark the nodes as missing that have blocked the simulation for longer than ``patience``.

        Args:
            stamp: Simulated time after the step that is blocked [s].
            wall: Wall clock [s].

        Returns:
            Names of the nodes given up by this call.
        """
        if self._blocked_since is None or wall - self._blocked_since < self._patience:
            return []
        given_up = self.lagging_nodes(stamp)
        self._missing.update(given_up)
        self._given_up.update(given_up)
        for name in given_up:
            self._gaps.pop(name, None)
        self._blocked_since = None
        return given_up

    def _speed_delay(self, stamp: float, wall: float) -> float:
        speed = self.speed
        is_limited = self.limited_by or self._missing - self.synchronised_nodes
        if is_limited and not 0.0 < speed < REAL_TIME:
            speed = REAL_TIME
        if speed == 0.0:
            self._anchor_speed = speed
            return 0.0
        due = self._anchor_wall + (stamp - self._anchor_stamp) / speed
        if speed != self._anchor_speed or wall > due + FORGIVEN_DELAY:
            self._anchor_wall, self._anchor_stamp, self._anchor_speed = wall, stamp, speed
            return 0.0
        return max(0.0, due - wall)
