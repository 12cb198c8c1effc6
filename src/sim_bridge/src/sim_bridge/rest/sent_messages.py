"""Which messages may have a node work that rested before they were sent."""

from collections import Counter
from typing import Collection, Dict, Iterable, Mapping, Tuple

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


def are_any_woken(
    sent: SentCounts, before: SentCounts, takes_part: Mapping[str, bool], with_all: bool
) -> bool:
    """Return whether something was sent that may have a node work, whose work matters now.

    What a node does whose messages no other one receives, or with messages that it keeps, matters only when
    the clock is sent, or readings.

    Args:
        sent: Numbers of messages sent.
        before: The same when all nodes rested.
        takes_part: Whether another node receives messages of a node, by the nodes that are waited for.
        with_all: Whether all nodes and messages matter.
    """
    changed = (key for key, count in sent.items() if count != before.get(key, 0))
    return any(
        name == TICKS or name in takes_part and (with_all or not is_kept and takes_part[name])
        for name, is_kept in changed
    )
