"""Lock-step of a simulation with its nodes: which nodes take part, which ticks they have answered."""

import math
from dataclasses import dataclass, field
from typing import Dict, FrozenSet, List, Mapping, Optional, Tuple

# Stamps nearer to each other than this are equal [s].
SAME = 1e-6
NEVER = -1.0


@dataclass
class _Member:
    """A synchronised node.

    Attributes:
        period: Longest time between two ticks that it accepts [simulated s].
        answered: Number of the latest tick that it has answered.
        sent: Messages it has sent up to that tick, by channel.
    """

    period: float
    answered: int
    sent: Dict[str, int] = field(default_factory=dict)


class LockStepCoordinator:
    """Decides when a tick is due, and which nodes must have answered before simulated time may pass.

    A tick is an instant of simulated time at which all synchronised nodes work. The messages that a node
    sends at a tick are delivered ``latency`` seconds later, or at the next tick if that comes first. Time may
    pass up to there while the nodes work.

    Channels are texts "sender receiver topic".

    Args:
        latency: Time between a tick and the delivery of the messages sent at it [simulated s].

    Attributes:
        delay: Time of the ticks after the multiples of their period [simulated s].
    """

    def __init__(self, latency: float):
        self._latency = latency
        self.delay = 0.0
        self.members: FrozenSet[str] = frozenset()
        self._members: Dict[str, _Member] = {}
        self._number = 0
        self._stamp = self._held_until = NEVER
        self._members_changed = False

    @property
    def period(self) -> float:
        """Time between two ticks [s]: the shortest period of a member."""
        return min((member.period for member in self._members.values()), default=self._latency)

    @property
    def latency(self) -> float:
        """Time between a tick and the delivery of the messages sent at it [s], at most the period."""
        return min(self._latency, self.period)

    def add_member(self, name: str, period: float) -> None:
        """Add a node, from the next tick on.

        Args:
            name: Name of the node.
            period: Longest time between two ticks that it accepts [simulated s].
        """
        self._members[name] = _Member(period, self._number)
        self.members, self._members_changed = frozenset(self._members), True

    def remove_member(self, name: str) -> None:
        """Remove a node and the message counts of the channels to it.

        A node that joins later under the same name starts its counts at 0.
        """
        self._members.pop(name, None)
        for member in self._members.values():
            member.sent = {
                channel: count for channel, count in member.sent.items() if channel.split(" ")[1] != name
            }
        self.members, self._members_changed = frozenset(self._members), True

    def reset_time(self) -> None:
        """Restart simulated time; messages of the current tick are delivered before it passes."""
        self._stamp = self._held_until = NEVER
        self._members_changed = True

    def record_answer(self, name: str, number: int, sent: Mapping[str, int]) -> None:
        """Record the answer of a node to a tick.

        Args:
            name: The node.
            number: Number of the tick.
            sent: Total of messages it has sent, by channel; only those that have changed.
        """
        member = self._members.get(name)
        if member is not None:
            member.answered = number
            member.sent.update(sent)

    def delivery_due(self, stamp: float) -> bool:
        """Return whether the messages of the latest tick are delivered at ``stamp`` [simulated s]."""
        return self.tick_due(stamp) or stamp >= self._stamp + self.latency - SAME

    def unanswered(self) -> List[str]:
        """Return the members that have not answered the latest tick."""
        return sorted(name for name, member in self._members.items() if member.answered < self._number)

    def sent_counts(self) -> Dict[str, int]:
        """Return the total of messages that members have sent up to the latest tick, by channel."""
        return {channel: count for member in self._members.values() for channel, count in member.sent.items()}

    def is_tick(self, stamp: float) -> bool:
        """Return whether the latest tick began at ``stamp`` [simulated s]."""
        return self._number > 0 and abs(stamp - self._stamp) < SAME

    def hold(self, until: float) -> None:
        """Begin no tick before ``until`` [simulated s], unless the members change."""
        self._held_until = until

    def begin_tick(self, stamp: float) -> Optional[Tuple[int, bool]]:
        """Begin the tick that is due at ``stamp`` [simulated s].

        Returns:
            The number of the tick, and whether the members have changed since the last one; None if none is
            due.
        """
        if not self.tick_due(stamp):
            return None
        members_changed, self._members_changed = self._members_changed, False
        self._number, self._stamp = self._number + 1, stamp
        return self._number, members_changed

    def tick_due(self, stamp: float) -> bool:
        """Return whether a tick begins at ``stamp`` [simulated s].

        Ticks are at multiples of the period, where sensors of that rate have just measured.
        """
        if self._members_changed or not self._members:
            return self._members_changed
        if stamp < self._held_until - SAME:
            return False
        period, delay = self.period, self.delay - SAME
        return math.floor((stamp - delay) / period) > math.floor((self._stamp - delay) / period)
