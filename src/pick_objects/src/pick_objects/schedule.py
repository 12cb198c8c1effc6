"""In which order the deliveries of a mission are made, and which can be made at all."""

from typing import Dict, List, Mapping, Optional, Sequence, Set, Tuple

from pick_objects.job import ENDED, DeliveryJob, DeliveryStage
from pick_objects.mission import Delivery, Mission
from pick_objects.ordering import shortest_order
from planar import Pose2
from planar.maps.places import NamedPlace

UNREACHABLE_LENGTH = 1e6
"""Metres that a way counts which no planner has found: it is left for last."""


class DeliverySchedule:
    """``jobs``: the deliveries in the order in which they are carried out.

    ``is_settled``: whether that is the order wanted; for the shortest one the lengths of ways are needed.
    """

    def __init__(self, mission: Mission):
        self.jobs: List[DeliveryJob] = [DeliveryJob(delivery) for delivery in mission.deliveries]
        self._given = [job.delivery for job in self.jobs]
        self._wants_shortest = mission.settings.order == "shortest"
        self.is_ordered = not self._wants_shortest

    @property
    def waiting(self) -> List[DeliveryJob]:
        return [job for job in self.jobs if job.stage is DeliveryStage.WAITING]

    @property
    def carried_job(self) -> Optional[DeliveryJob]:
        """The one whose object is on the robot, if any."""
        return next((job for job in self.jobs if job.stage is DeliveryStage.CARRYING), None)

    @property
    def has_failed(self) -> bool:
        """Whether a delivery has."""
        return any(job.stage is DeliveryStage.FAILED for job in self.jobs)

    def add(self, delivery: Delivery) -> None:
        self.jobs.append(DeliveryJob(delivery))
        self._given.append(delivery)
        self.is_ordered = not self._wants_shortest

    def next_job(self) -> DeliveryJob:
        """The first that waits for no other delivery; there must be some that wait."""
        return next(job for job in self.waiting if not self._before(job))

    def fail_blocked(self) -> None:
        """Fails what waits for deliveries that will never be made."""
        jobs: Dict[str, DeliveryJob] = {job.delivery.name: job for job in self.jobs}
        for delivery in self._given:
            job = jobs[delivery.name]
            lost = [
                name
                for name in delivery.after
                if jobs[name].stage in (DeliveryStage.FAILED, DeliveryStage.CANCELLED)
            ]
            if lost and job.stage is DeliveryStage.WAITING:
                job.fail(f"{lost[0]} was not delivered")

    def ways(self, places: Mapping[str, NamedPlace]) -> Tuple[Tuple[Optional[Pose2], Pose2], ...]:
        """Of those that wait: from the robot to each source, then from each destination to each source."""
        waiting = self.waiting
        sources = [places[job.delivery.source].pose for job in waiting]
        ends = [places[job.delivery.destination].pose for job in waiting]
        return tuple((start, source) for start in (None, *ends) for source in sources)

    def apply_path_lengths(self, lengths: Sequence[Optional[float]]) -> None:
        """Takes the order that makes the ways shortest, told the ``lengths`` of those ways, None for no way.

        If a delivery was cancelled or added meanwhile, nothing is settled.
        """
        waiting = self.waiting
        count = len(waiting)
        self.is_ordered = len(lengths) == count * (count + 1)
        if self.is_ordered:
            metres = [UNREACHABLE_LENGTH if length is None else length for length in lengths]
            rows = [metres[i * count : (i + 1) * count] for i in range(count + 1)]
            before: List[Set[int]] = [
                {waiting.index(other) for other in self._before(job)} for job in waiting
            ]
            best = [waiting[i] for i in shortest_order(rows[0], rows[1:], before)]
            self.jobs = [job for job in self.jobs if job.stage is not DeliveryStage.WAITING] + best

    def _before(self, job: DeliveryJob) -> List[DeliveryJob]:
        """The deliveries under way or waiting that must come before this one."""
        earlier = self._given[: self._given.index(job.delivery)]
        same_object = {
            delivery.name for delivery in earlier if delivery.object_name == job.delivery.object_name
        }
        names = same_object | set(job.delivery.after)
        return [other for other in self.jobs if other.delivery.name in names and other.stage not in ENDED]
