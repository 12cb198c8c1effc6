"""Which messages may have a node work that rested before they were sent."""

from collections import Counter
from typing import Collection, Dict, FrozenSet, Iterable, Mapping, Set, Tuple

# Receiver of ticks, which may have any synchronised node send messages to the others.
TICKS = "ticks"
# Numbers of messages sent, by receiver and whether it only keeps them.
SentCounts = Dict[Tuple[str, bool], int]


def sent_counts(
    connections: Iterable[Tuple[str, str, int]], kept: Mapping[str, Collection[str]]
) -> SentCounts:
    """Sum the messages sent to each node.

    Args:
        connections: Receiver, topic and number of messages sent of each connection.
        kept: Topics whose messages a node keeps until another one has it work, by node.
    """
    counts: SentCounts = Counter()
    for receiver, topic, count in connections:
        counts[receiver, topic in kept.get(receiver, ())] += count
    return counts


def acting_nodes(
    receivers: Mapping[str, Collection[str]], simulator: Collection[str], synchronised: Collection[str]
) -> FrozenSet[str]:
    """Return the nodes whose work between two ticks has an effect before the next one.

    These are the nodes whose messages reach the simulator, also through others. What synchronised nodes
    receive has its effect at their next tick, and until the clock is sent it is one instant for all others.

    Args:
        receivers: Who receives messages of a node, by the node.
        simulator: Names of the simulator, and of the nodes that call its services.
        synchronised: The synchronised nodes.
    """
    reached: Set[str] = set(simulator)
    while True:
        senders = {name for name, others in receivers.items() if reached.intersection(others)}
        further = senders - reached - set(synchronised)
        if not further:
            return frozenset(reached & receivers.keys())
        reached |= further


class SentMessages:
    """What was sent since all nodes rested: it may have some of them work.

    Attributes:
        acting: Nodes that act before the next tick.
    """

    def __init__(self) -> None:
        self.acting: FrozenSet[str] = frozenset()
        self._before: SentCounts = {}
        self._now: SentCounts = {}

    def wake_any(self, sent: SentCounts, nodes: Collection[str], is_clock_next: bool, with_all: bool) -> bool:
        """Return whether something was sent that may have a node work, whose work matters now.

        What a node does that does not act, or with messages that it keeps, matters only when the clock is
        sent, or readings; what synchronised nodes send at a tick, only if a node acts, or before the clock.

        Args:
            sent: Numbers of messages sent.
            nodes: The nodes that are waited for.
            is_clock_next: Whether the clock is sent next.
            with_all: Whether all messages to these nodes matter.
        """
        for (name, is_kept), count in sent.items():
            if count == self._before.get((name, is_kept), 0):
                continue
            if name == TICKS and (is_clock_next or self.acting):
                return True
            if name in nodes and (with_all or not is_kept and name in self.acting):
                return True
        return False

    def await_rest(self, sent: SentCounts) -> None:
        """Note what was sent before the nodes are waited for."""
        self._now = sent

    def note_rest(self) -> None:
        """Note that they have rested since."""
        self._before = self._now

    def note_idle(self, sent: SentCounts) -> None:
        """Note that what was sent has had no node work, but for the ticks."""
        ticks = {key: self._before.get(key, 0) for key in sent if key[0] == TICKS}
        self._before = {**sent, **ticks}
