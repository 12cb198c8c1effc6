"""Pace of simulated time beside nodes that do not take part in lock-step: time passes when they rest."""

from dataclasses import dataclass, field
from typing import Callable, Container, Dict, Mapping, Optional

# Time for which all nodes must rest after a message of the clock [wall s], from a look at which they did, if
# one has loops or timers of roscpp: these look at the clock each millisecond.
POLLING_SECONDS = 0.0012
# The same after a message of the clock if one has threads that take turns (preload/ordered_wake.cpp): they
# wait for each other in short sleeps, as if they rested.
TURNS_QUIET_SECONDS = 0.002
# The same after other messages, and without such loops: receivers are ready to run when they have been sent.
DATA_QUIET_SECONDS = 0.0003
# The same before a message of the clock where nodes send each other messages, and before a tick: what one has
# sent to another may still be under way.
BETWEEN_NODES_QUIET_SECONDS = 0.001
# The same while nodes start, which look for each other with longer pauses.
SETTLING_QUIET_SECONDS = 0.03
# Shortest time between two looks [wall s].
LOOK_SECONDS = 0.0003
# Looks at which all nodes must rest in succession, spread over the time for which they must: a node may hand
# over to one that was looked at before.
LOOKS = 2
# Messages of a node that floods do not hold the simulation: of so many looks at one barrier they may.
MOST_NEWS = 20
# Time after which a node that does not rest is given up, and time in which it must then rest at most of the
# looks to be waited for again [wall s].
PATIENCE_SECONDS, OTHERS_PATIENCE_SECONDS, RECOVERY_SECONDS = 5.0, 0.5, 2.0
# Looks at which a node must have been busy before it is given up, per second of patience: where a machine
# stands still, or many programs share it, time passes in which no node can come to rest.
BUSY_LOOKS_PER_SECOND = 400.0


@dataclass(frozen=True)
class AwaitedRest:
    """What a barrier waits for.

    Attributes:
        nodes: Functions that return whether a node rests, by its name.
        awaited: The nodes for which the simulation has full patience; others may only take part in what these
            do.
        quiet: Time for which all nodes must rest [wall s].
        from_first_rest: Count it from the first look at which they did, not from the barrier's begin.
        have_polled: Whether all threads that look at the clock have done so since that look, which is enough.
    """

    nodes: Mapping[str, Callable[[], bool]]
    awaited: Container[str]
    quiet: float
    from_first_rest: bool = False
    have_polled: Callable[[], bool] = lambda: False


@dataclass
class _Barrier:
    """A barrier at which the simulation waits.

    Attributes:
        begun: When the simulation reached it [wall s].
        quiet_since: Since when all nodes rest [wall s]; None before the look that decides.
        busy: Node that did not rest at the latest look; None if all did.
        busy_looks: Number of looks at which a node was the first that did not rest, by name.
        rests: Number of the latest looks at which all nodes rested.
        news: Number of looks before which messages had arrived.
        next_look: When to look again [wall s].
    """

    begun: float
    quiet_since: Optional[float]
    busy: Optional[str] = None
    busy_looks: Dict[str, int] = field(default_factory=dict)
    rests: int = 0
    news: int = 0
    next_look: float = 0.0


@dataclass
class _Absence:
    """Looks at a node that is given up: since when [wall s], how many, and at how many it was busy."""

    since: float
    looks: int = 0
    busy: int = 0


class RestBarrier:
    """Decides whether simulated time may pass beside nodes that are known only by whether they rest.

    At a barrier the messages of the simulation have been sent, and a node that receives them, or whose timers
    the clock has reached, is ready to run until it has done its work. Nodes that wake each other are waited
    for as well, because all must rest at the same time. A node that is busy at one look only has looked at
    the clock. A node that does not rest for a long time is given up until it rests again.

    Args:
        patience: Time after which a node is given up [wall s].

    Attributes:
        given_up: Nodes that are not waited for, as they do not rest.
    """

    def __init__(self, patience: float = PATIENCE_SECONDS):
        self._patience = patience
        self._barrier: Optional[_Barrier] = None
        self.given_up: Dict[str, _Absence] = {}

    @property
    def is_begun(self) -> bool:
        """Whether the simulation waits at a barrier."""
        return self._barrier is not None

    def reset(self) -> None:
        """Leave the barrier, as simulated time restarts."""
        self._barrier = None

    def is_passed(self, wall: float, rest: AwaitedRest, has_news: bool) -> bool:
        """Return whether the nodes have rested at this barrier; the next call is about the next barrier then.

        Args:
            wall: Wall clock [s].
            rest: What to wait for.
            has_news: Whether a message has arrived since the last call: a node may not have rested before.
        """
        nodes, quiet = rest.nodes, rest.quiet
        restart = None if rest.from_first_rest else wall
        barrier = self._barrier
        if barrier is None:
            first = LOOK_SECONDS if rest.from_first_rest else quiet / LOOKS
            self._barrier = _Barrier(wall, restart, next_look=wall + first)
            return False
        if has_news and barrier.news < MOST_NEWS:
            barrier.news, barrier.quiet_since = barrier.news + 1, restart
        if wall < barrier.next_look:
            return False
        self._recover(wall, nodes)
        before, barrier.busy = (
            barrier.busy,
            next((name for name, rests in nodes.items() if name not in self.given_up and not rests()), None),
        )
        if barrier.busy is not None:
            barrier.rests, barrier.next_look = 0, wall + LOOK_SECONDS
            is_late = self._is_late(barrier, barrier.busy, rest.awaited, wall)
            if barrier.busy == before:
                barrier.quiet_since = restart
                if is_late:
                    self.given_up[barrier.busy] = _Absence(wall)
            return False
        barrier.rests += 1
        barrier.quiet_since = wall if barrier.quiet_since is None else barrier.quiet_since
        rested = wall - barrier.quiet_since
        is_enough = rested >= quiet or rest.from_first_rest and rested >= LOOK_SECONDS and rest.have_polled()
        is_over = barrier.rests >= LOOKS and is_enough
        spread = LOOK_SECONDS if rest.from_first_rest else quiet / LOOKS
        barrier.next_look = wall + max(LOOK_SECONDS, min(spread, quiet - rested))
        if is_over:
            self._barrier = None
        return is_over

    def _is_late(self, barrier: _Barrier, name: str, awaited: Container[str], wall: float) -> bool:
        """Count a look at which a node did not rest; return whether that has exhausted the patience."""
        looks = barrier.busy_looks[name] = barrier.busy_looks.get(name, 0) + 1
        patience = self._patience if name in awaited else OTHERS_PATIENCE_SECONDS
        return wall - barrier.begun > patience and looks > BUSY_LOOKS_PER_SECOND * patience

    def pause(self, wall: float) -> float:
        """Return the time until the next look [s].

        Args:
            wall: Wall clock [s].
        """
        return max(0.0, self._barrier.next_look - wall) if self._barrier else LOOK_SECONDS

    def waiting_for(self) -> str:
        """Return a node that the simulation waits for; empty if there is none."""
        return (self._barrier.busy or "") if self._barrier else ""

    def _recover(self, wall: float, nodes: Mapping[str, Callable[[], bool]]) -> None:
        """Wait again for nodes that have rested at most looks for some time: the clock wakes all of them."""
        for name, absence in list(self.given_up.items()):
            if name not in nodes:
                del self.given_up[name]
                continue
            absence.looks, absence.busy = absence.looks + 1, absence.busy + (not nodes[name]())
            if wall - absence.since > RECOVERY_SECONDS:
                if 2 * absence.busy > absence.looks:
                    self.given_up[name] = _Absence(wall)
                else:
                    del self.given_up[name]
