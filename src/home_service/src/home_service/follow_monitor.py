"""Judge by ground truth whether one robot follows another."""

from collections import OrderedDict
from typing import Any, Dict, List, Optional

from evaluation.event_stream import EventStream
from evaluation.events import BodiesTouched, OtherRobotUpdated, TruthUpdated
from planar import Pose2

# Distance within which a follower is close to its leader [m], and share of the time in which it must be.
MAX_DISTANCE, REQUIRED_SHARE = 1.5, 0.9
# Distance from its start at which the leader has departed [m].
DEPARTURE_DISTANCE = 0.05
# Messages by which the true poses of one robot may be ahead of the other's.
MAX_UNPAIRED = 500


class FollowMonitor:
    """Distance of a follower from its leader, from the leader's departure on.

    Only stamps with the true poses of both robots count.

    Args:
        namespace: Namespace of the follower; the leader has none.

    Attributes:
        collisions: What the follower touched.
    """

    def __init__(self, namespace: str):
        self.collisions: List[str] = []
        self._namespace = namespace
        self._start: Optional[Pose2] = None
        self._has_departed = False
        self._unpaired: OrderedDict[float, Pose2] = OrderedDict()
        self._seen, self._near, self._farthest = 0, 0, 0.0

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        events.subscribe(TruthUpdated, self._on_leader)
        events.subscribe(OtherRobotUpdated, self._on_follower)

    @property
    def share(self) -> float:
        """Share of the time in which the follower was close to its leader."""
        return self._near / max(self._seen, 1)

    @property
    def failure(self) -> Optional[str]:
        """Why the follower has failed; None if it has not."""
        if self.collisions:
            return f"the follower collided with {', '.join(sorted(set(self.collisions)))}"
        return None if self.share >= REQUIRED_SHARE else f"{self.description} only"

    @property
    def description(self) -> str:
        """How well it followed, in words."""
        return f"the follower was within {MAX_DISTANCE} m for {100.0 * self.share:.0f} % of the time"

    def result_fields(self) -> Dict[str, Any]:
        """Return fields of result.json."""
        return {
            "follower_share_near": round(self.share, 4),
            "follower_farthest": round(self._farthest, 3),
            "follower_collisions": self.collisions,
        }

    def _on_leader(self, event: TruthUpdated) -> None:
        self._start = self._start or event.pose
        self._has_departed = self._has_departed or event.pose.distance_to(self._start) > DEPARTURE_DISTANCE
        if self._has_departed:
            self._on_truth(event)

    def _on_follower(self, other: OtherRobotUpdated) -> None:
        if other.robot != self._namespace:
            return
        if isinstance(other.event, TruthUpdated):
            self._on_truth(other.event)
        elif isinstance(other.event, BodiesTouched):
            self.collisions += other.event.names

    def _on_truth(self, event: TruthUpdated) -> None:
        partner = self._unpaired.pop(event.stamp, None)
        if partner is None:
            self._unpaired[event.stamp] = event.pose
            if len(self._unpaired) > MAX_UNPAIRED:
                self._unpaired.popitem(last=False)
            return
        distance = event.pose.distance_to(partner)
        self._seen += 1
        self._near += distance <= MAX_DISTANCE
        self._farthest = max(self._farthest, distance)
