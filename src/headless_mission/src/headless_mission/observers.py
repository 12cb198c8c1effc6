"""Observers of an episode: they record and judge, and nothing in the episode depends on them."""

from typing import List, Optional, Set, Tuple

import numpy as np

from add_markers import CarriedParcel
from evaluation.delivery_monitor import DeliveryMonitor
from evaluation.events import DELETE, SHOW, MarkerUpdated
from evaluation.marker_log import PARCEL, MarkerLog
from evaluation.pedestrian_contacts import PedestrianContacts
from evaluation.verdict import ERRAND, MARKERS, MissionRecord, Verdict, judge
from headless_mission.errand import ErrandHooks
from headless_mission.navigation import NavigationHooks
from headless_mission.result import EpisodeResult
from pick_objects import FinishTask
from planar import Pose2
from sim_bridge import Episode, EpisodeHooks, Simulation, StepResult


class ContactObserver(EpisodeHooks):
    """Records what the robot collides with, and true poses of robot and pedestrians at each tick.

    Args:
        simulation: Simulation with robot and pedestrians.

    Attributes:
        collisions: Names of what the robot has collided with, one entry a step and body.
        trajectory: Stamp [s] and true x, y, yaw at each recorded tick.
        contacts: Who was at fault, and the tracks of pedestrians.
    """

    def __init__(self, simulation: Simulation):
        self.contacts = PedestrianContacts(simulation)
        self.collisions: List[str] = []
        self.trajectory: List[Tuple[float, float, float, float]] = []

    def after_step(self, episode: Episode, step: StepResult) -> None:
        self.collisions.extend(self.contacts.robot_collisions(step))

    def record(self, stamp: float, truth: Pose2) -> None:
        """Record the true poses.

        Args:
            stamp: Time to record [s].
            truth: True pose of the robot in the world.
        """
        self.trajectory.append((stamp, truth.x, truth.y, truth.yaw))
        self.contacts.record()


class MissionObserver(ContactObserver):
    """Records deliveries, markers, collisions and the errors of localization; its hooks follow the errand's.

    Args:
        simulation: Simulation with robot and pedestrians.
        navigation: move_base in the episode.
        errand: The mission.
        parcel: Marker of an errand, checked by the verdict; None: no marker.
    """

    def __init__(
        self,
        simulation: Simulation,
        navigation: NavigationHooks,
        errand: ErrandHooks,
        parcel: Optional[CarriedParcel],
    ):
        super().__init__(simulation)
        places = errand.errand.mission.places
        self._navigation, self._errand, self._parcel = navigation, errand, parcel
        self._record = MissionRecord()
        self._deliveries = DeliveryMonitor(places, self._record.deliveries, lambda line: None)
        self._markers = MarkerLog(places, self._record)
        self._errors: List[float] = []

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        base_in_map, truth = self._navigation.base_in_map, step.base_in_world
        if base_in_map is None:
            return
        self.record(step.stamp, truth)
        self._errors.append(truth.distance_to(base_in_map))
        if self._parcel is not None:
            shown_at = self._parcel.update(step.stamp, base_in_map)
            at, action = (Pose2(), DELETE) if shown_at is None else (shown_at, SHOW)
            self._markers.add(MarkerUpdated(step.stamp, PARCEL, 0, (at.x, at.y, 0.0), action))
        if self._errand.is_started:
            errand = self._errand.errand
            self._record.final_state = errand.state.value
            for job in errand.jobs:
                self._deliveries.update(job.delivery, job.stage, job.attempts, job.reason, truth)

    def result(self, end: FinishTask, wall_seconds: float) -> EpisodeResult:
        """Judge the episode.

        Args:
            end: End of the mission.
            wall_seconds: Wall-clock time of the episode [s].
        """
        self._record.collisions.extend(self.collisions)
        if not end.success:
            self._record.failure = end.reason
        self._record.reason = end.reason
        return EpisodeResult(
            self._verdict(),
            self._record,
            np.array(self.trajectory),
            np.array(self._errors),
            wall_seconds,
            self._navigation.diagnosis,
            self.contacts.track,
            self.contacts.people_at_fault,
        )

    def _verdict(self) -> Verdict:
        checks: Set[str] = {ERRAND, MARKERS} if self._parcel else {ERRAND}
        return judge(self._record, checks)
