"""Records where the robot was, how well it knew that, and what it touched."""

from typing import List, Tuple

from evaluation.event_stream import EventStream
from evaluation.events import BodiesTouched, EstimateUpdated, TruthUpdated
from planar import Pose2


class TrackRecorder:
    """Keeps every true pose, error and contact of a run that is short enough for it.

    Attributes:
        trajectory: Stamp [s] and true x, y, yaw of each event.
        localization_errors: Distance of each estimate from the latest true position [m].
        collisions: Name of the body at each contact.
    """

    def __init__(self) -> None:
        self.trajectory: List[Tuple[float, float, float, float]] = []
        self.localization_errors: List[float] = []
        self.collisions: List[str] = []
        self._truth = Pose2()

    def attach(self, events: EventStream) -> None:
        """Subscribe to events."""
        events.subscribe(TruthUpdated, self._on_truth)
        events.subscribe(EstimateUpdated, self._on_estimate)
        events.subscribe(BodiesTouched, self._on_contact)

    def _on_truth(self, event: TruthUpdated) -> None:
        self._truth = pose = event.pose
        self.trajectory.append((event.stamp, pose.x, pose.y, pose.yaw))

    def _on_estimate(self, event: EstimateUpdated) -> None:
        self.localization_errors.append(self._truth.distance_to(event.pose))

    def _on_contact(self, event: BodiesTouched) -> None:
        self.collisions.extend(event.names)
