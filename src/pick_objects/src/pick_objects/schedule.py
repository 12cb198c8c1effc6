"""Order in which the deliveries of a mission are carried out, and which of them can be."""

from typing import Dict, List, Mapping, Optional, Sequence, Set, Tuple

from pick_objects.job import ENDED, DeliveryJob, DeliveryStage
from pick_objects.mission import Delivery, Mission
from pick_objects.ordering import shortest_order
from planar import Pose2
from planar.maps.places import NamedPlace

# Length of a leg for which no path was found, so that it comes last [m].
UNREACHABLE_LENGTH = 1e6


class DeliverySchedule:
    """Deliveries of a mission in their order.

    Args:
        mission: Mission to schedule.

    Attributes:
        jobs: Deliveries in the order of execution.
        is_ordered: The jobs are in the requested order; the shortest one needs the lengths of paths first.
    """

    def __init__(self, mission: Mission):
        self.jobs: List[DeliveryJob] = [DeliveryJob(delivery) for delivery in mission.deliveries]
        self._given = [job.delivery for job in self.jobs]
        self._is_shortest_requested = mission.settings.order == "shortest"
        self.is_ordered = not self._is_shortest_requested

    @property
    def waiting(self) -> List[DeliveryJob]:
        """Deliveries that have not been started."""
        return [job for job in self.jobs if job.stage is DeliveryStage.WAITING]

    @property
    def carried_job(self) -> Optional[DeliveryJob]:
        """Delivery whose object is on the robot, if any."""
        return next((job for job in self.jobs if job.stage is DeliveryStage.CARRYING), None)

    @property
    def has_failed(self) -> bool:
        """Whether a delivery has failed."""
        return any(job.stage is DeliveryStage.FAILED for job in self.jobs)

    def add(self, delivery: Delivery) -> None:
        """Append a delivery."""
        self.jobs.append(DeliveryJob(delivery))
        self._given.append(delivery)
        self.is_ordered = not self._is_shortest_requested

    def next_job(self) -> DeliveryJob:
        """Return the first waiting delivery that depends on no other; at least one must be waiting."""
        return next(job for job in self.waiting if not self._before(job))

    def fail_blocked(self) -> None:
        """Fail waiting deliveries that depend on one which has failed or was cancelled."""
        jobs: Dict[str, DeliveryJob] = {job.delivery.name: job for job in self.jobs}
        for delivery in self._given:
            job = jobs[delivery.name]
            missing = [
                name
                for name in delivery.after
                if jobs[name].stage in (DeliveryStage.FAILED, DeliveryStage.CANCELLED)
            ]
            if missing and job.stage is DeliveryStage.WAITING:
                job.fail(f"{missing[0]} was not delivered")

    def legs(self, places: Mapping[str, NamedPlace]) -> Tuple[Tuple[Optional[Pose2], Pose2], ...]:
        """Of those that wait: from the robot to each source, then from each destination to each source."""
        waiting = self.waiting
        sources = [places[job.delivery.source].pose for job in waiting]
        ends = [places[job.delivery.destination].pose for job in waiting]
        return tuple((start, source) for start in (None, *ends) for source in sources)

    def apply_path_lengths(self, lengths: Sequence[Optional[float]]) -> None:
        """Sort the waiting deliveries into the order with the shortest total path.

        Lengths are ignored if a delivery was added or cancelled after the legs were requested.

        Args:
            lengths: Lengths of the legs as returned by ``legs`` [m]; None for a leg without a path.
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
        """Return unfinished deliveries that must be completed before this one."""
        earlier = self._given[: self._given.index(job.delivery)]
        same_object = {
            delivery.name for delivery in earlier if delivery.object_name == job.delivery.object_name
        }
        names = same_object | set(job.delivery.after)
        return [other for other in self.jobs if other.delivery.name in names and other.stage not in ENDED]
