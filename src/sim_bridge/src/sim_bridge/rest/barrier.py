"""Pace of simulated time beside nodes that do not take part in lock-step: time passes when they rest."""

from dataclasses import dataclass
from typing import Callable, Container, Dict, Mapping, Optional

# Time between two barriers [simulated s]; shorter than the period of a usual control loop.
BARRIER_PERIOD = 0.05
# Time for which all nodes must rest at a barrier [wall s]. A loop of roscpp that sleeps in simulated time
# looks at the clock each millisecond.
QUIET_SECONDS = 0.002
# The same while nodes start, which look for each other with longer pauses.
SETTLING_QUIET_SECONDS = 0.02
# Time between two looks [wall s].
LOOK_SECONDS = 0.0003
# Messages of a node that floods do not hold the simulation: of so many looks at one barrier they may.
MOST_NEWS = 20
# Time after which a node that does not rest is given up, and for which it must then rest until it is waited
# for again [wall s].
PATIENCE_SECONDS, OTHERS_PATIENCE_SECONDS, RECOVERY_SECONDS = 5.0, 0.5, 2.0


@dataclass
class _Barrier:
    """A barrier at which the simulation waits.

    Attributes:
        begun: When the simulation reached it [wall s].
        quiet_since: Since when all nodes rest [wall s].
        busy: Node that did not rest at the latest look.
        news: Number of looks before which messages had arrived.
    """

    begun: float
    quiet_since: float
    busy: str = ""
    news: int = 0


class RestBarrier:
    """Decides whether simulated time may pass beside nodes that are known only by whether they rest.

    At a barrier, each 0.05 s of simulated time, the messages of the simulation have been sent, and a node
    that receives them, or whose timers the clock has reached, is ready to run until it has done its work.
    Nodes that wake each other are waited for as well, because all must rest at the same time. A node that
    does not rest for a long time is given up until it rests again.

    Args:
        period: Time between two barriers [simulated s].
        quiet: Time for which all nodes must rest [wall s].
        patience: Time after which a node is given up [wall s].

    Attributes:
        given_up: Nodes that are not waited for, as they do not rest.
    """

    def __init__(
        self,
        period: float = BARRIER_PERIOD,
        quiet: float = QUIET_SECONDS,
        patience: float = PATIENCE_SECONDS,
    ):
        self._period, self._quiet, self._patience = period, quiet, patience
        self._next = 0.0
        self._barrier: Optional[_Barrier] = None
        self.given_up: Dict[str, float] = {}

    def reset(self) -> None:
        """Discard the time of the next barrier, as simulated time restarts."""
        self._next, self._barrier = 0.0, None

    def may_step(
        self,
        stamp: float,
        wall: float,
        nodes: Mapping[str, Callable[[], bool]],
        awaited: Container[str],
        has_news: bool,
        is_settling: bool = False,
    ) -> bool:
        """Return whether the next step may be taken.

        Args:
            stamp: Present simulated time [s].
            wall: Wall clock [s].
            nodes: Functions that return whether a node rests, by its name.
            awaited: The nodes for which the simulation has full patience; others may only take part in what
                these do.
            has_news: Whether a message has arrived since the last call: a node may not have rested before.
            is_settling: Whether nodes are starting.
        """
        if stamp < self._next - 1e-9:
            return True
        barrier = self._barrier
        if barrier is None:
            self._barrier = barrier = _Barrier(wall, wall)
        elif has_news and barrier.news < MOST_NEWS:
            barrier.news, barrier.quiet_since = barrier.news + 1, wall
        self._recover(wall, nodes)
        barrier.busy = next(
            (name for name, rests in nodes.items() if name not in self.given_up and not rests()), ""
        )
        if barrier.busy:
            barrier.quiet_since = wall
            patience = self._patience if barrier.busy in awaited else OTHERS_PATIENCE_SECONDS
            if wall - barrier.begun > patience:
                self.given_up[barrier.busy] = wall
            return False
        if wall - barrier.quiet_since < (SETTLING_QUIET_SECONDS if is_settling else self._quiet):
            return False
        self._barrier = None
        self._next = stamp + self._period
        return True

    def waiting_for(self) -> str:
        """Return a node that the simulation waits for; empty if there is none."""
        return self._barrier.busy if self._barrier else ""

    def _recover(self, wall: float, nodes: Mapping[str, Callable[[], bool]]) -> None:
        """Wait again for nodes that have rested at each look for some time."""
        for name, busy_at in list(self.given_up.items()):
            if name not in nodes:
                del self.given_up[name]
            elif not nodes[name]():
                self.given_up[name] = wall
            elif wall - busy_at > RECOVERY_SECONDS:
                del self.given_up[name]
