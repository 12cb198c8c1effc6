"""Observers of an episode: they publish its run events, and nothing in the episode depends on them."""

from typing import List, Optional, Sequence, Set, Tuple

import numpy as np

from add_markers import CarriedParcel
from evaluation.consumers.referee import Referee
from evaluation.consumers.track_recorder import TrackRecorder
from evaluation.event_stream import EventStream, Latest
from evaluation.events import (
    DELETE,
    SHOW,
    BodiesTouched,
    DeliveryProgress,
    EstimateUpdated,
    MarkerUpdated,
    MissionUpdated,
    SensorDistrusted,
    TruthUpdated,
)
from evaluation.marker_log import PARCEL
from evaluation.pedestrian_contacts import PedestrianContacts
from evaluation.verdict import ERRAND, MARKERS, true_places
from headless_mission.errand import ErrandHooks
from headless_mission.navigation import NavigationHooks
from headless_mission.result import EpisodeResult
from pick_objects import Delivery, Errand, FinishTask
from planar import Pose2, Twist2
from planar.maps.semantic_map import PlacedObject
from sim_bridge import Episode, EpisodeHooks, Simulation, StepResult


class ContactObserver(EpisodeHooks):
    """Publishes what the robot collides with, and its true pose when asked to.

    Args:
        simulation: Simulation with robot and pedestrians.

    Attributes:
        events: Events of the episode.
        contacts: Who was at fault, and the tracks of pedestrians.
    """

    def __init__(self, simulation: Simulation):
        self.events = EventStream()
        self.contacts = PedestrianContacts(simulation)
        self._recorder = TrackRecorder()
        self._recorder.attach(self.events)

    @property
    def collisions(self) -> List[str]:
        """Names of what the robot has collided with, one entry a step and body."""
        return self._recorder.collisions

    @property
    def trajectory(self) -> List[Tuple[float, float, float, float]]:
        """Stamp [s] and true x, y, yaw at each recorded tick."""
        return self._recorder.trajectory

    def after_step(self, episode: Episode, step: StepResult) -> None:
        names = self.contacts.robot_collisions(step)
        if names:
            self.events.publish(BodiesTouched(step.stamp, tuple(names)))

    def record(self, stamp: float, truth: Pose2, twist: Twist2 = Twist2()) -> None:
        """Publish the true state of the robot and record the pedestrians.

        Args:
            stamp: Time to record [s].
            truth: True pose of the robot in the world.
            twist: Its true velocity.
        """
        self.events.publish(TruthUpdated(stamp, truth, twist))
        self.contacts.record()


class MissionObserver(ContactObserver):
    """Publishes all events of a mission and judges it; its hooks follow the errand's.

    Args:
        simulation: Simulation with robot and pedestrians.
        navigation: move_base in the episode.
        errand: The mission.
        parcel: Marker of an errand, checked by the verdict; None: no marker.
        objects: Where objects truly are.
    """

    def __init__(
        self,
        simulation: Simulation,
        navigation: NavigationHooks,
        errand: ErrandHooks,
        parcel: Optional[CarriedParcel],
        objects: Sequence[PlacedObject] = (),
    ):
        super().__init__(simulation)
        self._navigation, self._errand, self._parcel = navigation, errand, parcel
        places = {**errand.errand.mission.places, **true_places(objects)}
        self._referee = Referee(places, log=lambda line: None)
        self._referee.attach(self.events)
        self._diagnosis = Latest(SensorDistrusted)
        self._diagnosis.attach(self.events)
        self._published_mission: Optional[MissionUpdated] = None
        self._published_marker: Optional[MarkerUpdated] = None

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        base_in_map = self._navigation.base_in_map
        if base_in_map is None:
            return
        self.record(step.stamp, step.base_in_world, step.twist)
        self.events.publish(EstimateUpdated(step.stamp, base_in_map))
        if self._parcel is not None:
            self._publish_marker(step.stamp, self._parcel.update(step.stamp, base_in_map))
        if self._errand.is_started:
            self._publish_mission(step.stamp)
        if self._navigation.diagnosis and self._diagnosis.event is None:
            self.events.publish(SensorDistrusted(step.stamp, self._navigation.diagnosis))

    def result(self, end: FinishTask, wall_seconds: float) -> EpisodeResult:
        """Judge the episode.

        Args:
            end: End of the mission.
            wall_seconds: Wall-clock time of the episode [s].
        """
        expected: Set[str] = {ERRAND, MARKERS} if self._parcel else {ERRAND}
        verdict = self._referee.verdict(expected, None if end.success else end.reason)
        return EpisodeResult(
            verdict,
            self._referee.mission_record,
            np.array(self.trajectory),
            np.array(self._recorder.localization_errors),
            wall_seconds,
            "" if self._diagnosis.event is None else self._diagnosis.event.reason,
            self.contacts.track,
            self.contacts.people_at_fault,
        )

    def _publish_marker(self, stamp: float, shown_at: Optional[Pose2]) -> None:
        """Publish the marker of the errand, if it has changed."""
        at, action = (Pose2(), DELETE) if shown_at is None else (shown_at, SHOW)
        last, position = self._published_marker, (at.x, at.y, 0.0)
        if last is None or (last.position, last.action) != (position, action):
            self._published_marker = MarkerUpdated(stamp, PARCEL, 0, position, action)
            self.events.publish(self._published_marker)

    def _publish_mission(self, stamp: float) -> None:
        """Publish the state of the mission, if it has changed."""
        errand, end, last = self._errand.errand, self._errand.end, self._published_mission
        state, reason = errand.state.value, "" if end is None else end.reason
        deliveries = tuple(
            DeliveryProgress(
                job.delivery, job.stage, job.attempts, job.reason, _reported_at(errand, job.delivery)
            )
            for job in errand.jobs
        )
        if last is None or (last.state, last.reason, last.deliveries) != (state, reason, deliveries):
            self._published_mission = MissionUpdated(stamp, state, deliveries, reason)
            self.events.publish(self._published_mission)


def _reported_at(errand: Errand, delivery: Delivery) -> Optional[Tuple[float, float]]:
    """Return where the robot knows the object of a delivery to be [m]; None if it does not."""
    location = errand.object_locations.get(delivery.object_name)
    return None if location is None else (location.pose.x, location.pose.y)
