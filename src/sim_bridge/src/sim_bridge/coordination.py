"""Which nodes are in step with a simulation, which moments they have answered, what takes effect when."""

from dataclasses import dataclass, field
from typing import Dict, FrozenSet, List, Mapping, Optional, Tuple

# Stamps this near each other are the same.
SAME = 1e-6
NEVER = -1.0


@dataclass
class _Member:
    """``answered``: number of the latest moment; ``sent``: messages by channel up to then."""

    period: float
    answered: int
    sent: Dict[str, int] = field(default_factory=dict)


class LockStepCoordinator:
    """Tells when a moment is due, and who must have answered before time may pass.

    What a node sends at a moment takes effect ``latency`` simulated seconds later, or at the next moment if
    that comes first. So time may pass up to there while the nodes work, and not beyond.
    """

    def __init__(self, latency: float):
        self._latency = latency
        self.members: FrozenSet[str] = frozenset()
        self._members: Dict[str, _Member] = {}
        self._number = 0
        self._moment = NEVER
        self._has_news = False

    @property
    def period(self) -> float:
        """Between two moments, seconds: the shortest that a node needs."""
        return min((member.period for member in self._members.values()), default=self._latency)

    @property
    def latency(self) -> float:
        """In force: seconds from a moment until what is sent then takes effect."""
        return min(self._latency, self.period)

    def add_node(self, name: str, period: float) -> None:
        """A node is in step from the next moment on."""
        self._members[name] = _Member(period, self._number)
        self.members, self._has_news = frozenset(self._members), True

    def remove_node(self, name: str) -> None:
        """A node is in step no more; the next of its name has had nothing of what was sent to it."""
        self._members.pop(name, None)
        for member in self._members.values():
            member.sent = {
                channel: count for channel, count in member.sent.items() if channel.split(" ")[1] != name
            }
        self.members, self._has_news = frozenset(self._members), True

    def restart(self) -> None:
        """Time begins anew; what the nodes are at now takes effect before it passes."""
        self._moment = NEVER
        self._has_news = True

    def acknowledge(self, name: str, number: int, sent: Mapping[str, int]) -> None:
        """A node has done what it had to do at the moment ``number``; ``sent``: what counts are new."""
        member = self._members.get(name)
        if member is not None:
            member.answered = number
            member.sent.update(sent)

    def is_complete(self, stamp: float) -> bool:
        """Whether what was sent at the latest moment takes effect at ``stamp``."""
        return self._is_due(stamp) or stamp >= self._moment + self.latency - SAME

    def pending_nodes(self) -> List[str]:
        """The nodes that have not answered the latest moment."""
        return sorted(name for name, member in self._members.items() if member.answered < self._number)

    def effective_counts(self) -> Dict[str, int]:
        """By channel, how many messages take effect when the moment is over and nobody awaited."""
        return {channel: count for member in self._members.values() for channel, count in member.sent.items()}

    def begin_tick(self, stamp: float) -> Optional[Tuple[int, bool]]:
        """The number of the moment at ``stamp``, and whether the members are others; None if none is due."""
        if not self._is_due(stamp):
            return None
        has_news, self._has_news = self._has_news, False
        self._number, self._moment = self._number + 1, stamp
        return self._number, has_news

    def _is_due(self, stamp: float) -> bool:
        """At multiples of the period, so that sensors of the same rate have just measured."""
        if self._has_news or not self._members:
            return self._has_news
        period = self.period
        return int((stamp + SAME) / period) > int((self._moment + SAME) / period)
