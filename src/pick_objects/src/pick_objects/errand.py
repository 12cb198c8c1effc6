"""Execution of a mission: one delivery after the other."""

from dataclasses import dataclass
from typing import Collection, Dict, List, Mapping, Optional, Sequence, Set, Tuple, Union

from pick_objects.approach import DriveToPlace
from pick_objects.delivery_execution import DeliveryExecution
from pick_objects.driving_time import DrivingTimeEstimator
from pick_objects.job import (
    ENDED,
    ON_ROBOT,
    STATE_OF_STAGE,
    DeliveryJob,
    DeliveryStage,
    ErrandState,
    ObjectLocation,
)
from pick_objects.mission import Delivery, Mission, MissionError
from pick_objects.schedule import DeliverySchedule
from pick_objects.search.area import SearchArea
from pick_objects.search.execution import LookForObject, LookTaken
from planar import Pose2
from planar.driving import FinishTask, GoalFailed, GoalReached, RobotDisplaced
from planar.elapsed_time import ElapsedTime
from planar.maps.places import NamedPlace


@dataclass(frozen=True)
class MeasurePathLengths:
    """Order: plan these legs and report their lengths.

    Attributes:
        legs: Start and end of each leg; a start of None is the robot's position.
    """

    legs: Tuple[Tuple[Optional[Pose2], Pose2], ...]


@dataclass(frozen=True)
class PathLengthsMeasured:
    """Event: lengths of the legs of the last order.

    Attributes:
        lengths: Metres; None where there is no path.
    """

    lengths: Tuple[Optional[float], ...]


Order = Union[DriveToPlace, LookForObject, MeasurePathLengths, FinishTask]
Event = Union[GoalReached, GoalFailed, RobotDisplaced, PathLengthsMeasured, LookTaken]


class Errand:
    """State machine of a mission: it receives the time and events, and returns orders.

    Args:
        mission: Mission to carry out.
        area: Where objects can be searched; None if there is no semantic map.

    Attributes:
        base_in_map: Estimated pose of the robot; set it before ``advance``.
        object_locations: Location of each object that is known, by name.
        added: Names of the deliveries that were added to the mission.
        is_cancelled: The whole mission was cancelled.
        reason: How the mission ended, in words; empty while it is running.
    """

    def __init__(self, mission: Mission, area: Optional[SearchArea] = None):
        self.mission, self.base_in_map, self._area = mission, Pose2(), area
        self.object_locations: Dict[str, ObjectLocation] = {}
        self.added: Set[str] = set()
        self.reason = ""
        self._place_objects()
        self._schedule = DeliverySchedule(mission)
        self._execution: Optional[DeliveryExecution] = None
        self.is_cancelled = self._is_measuring = self._is_over = False
        self._driving_time = DrivingTimeEstimator()
        self._elapsed = ElapsedTime()

    def advance(self, now: float, event: Optional[Event] = None) -> Optional[Order]:
        """Advance to the current time.

        Args:
            now: Time [s].
            event: Outcome of the last order, if there is a new one.

        Returns:
            The next order; None while nothing changes.
        """
        now = self._elapsed.update(now)
        if self._is_over:
            return None
        if self.is_cancelled:
            return self._end("cancelled")
        if self._is_measuring:
            return self._apply_order(now, event)
        if self._execution is None or self._execution.job.stage is DeliveryStage.CANCELLED:
            return self._begin_next(now)
        self._execution.base_in_map = self.base_in_map
        order = self._execution.advance(now, None if isinstance(event, PathLengthsMeasured) else event)
        return self._begin_next(now) if self._execution.job.stage in ENDED else order

    def add(self, delivery: Delivery) -> Delivery:
        """Append a delivery.

        Returns:
            The delivery with the name that it has been given.

        Raises:
            MissionError: If the mission is over or the delivery is not valid.
        """
        self._refuse_if_over()
        mission = self.mission.with_delivery(delivery)
        mission.check_searches(self._area.semantic_map if self._area else None)
        self.mission, added = mission, mission.deliveries[-1]
        self.added.add(added.name)
        self._schedule.add(added)
        self._place_objects()
        return added

    def resume(
        self,
        jobs: Sequence[DeliveryJob],
        object_locations: Mapping[str, ObjectLocation],
        is_cancelled: bool = False,
        added: Collection[str] = (),
    ) -> None:
        """Restore the state of an interrupted errand of this mission; call it before the first advance.

        Args:
            jobs: Deliveries in their order; at most one is under way, and that one is CARRYING.
            object_locations: Location of each object.
            is_cancelled: The mission was cancelled.
            added: Names of the deliveries that were added.
        """
        self._schedule.jobs = list(jobs)
        self.object_locations.update(object_locations)
        self.is_cancelled = is_cancelled
        self.added = set(added)

    def cancel(self, name: str = "") -> None:
        """Cancel a delivery, or the whole mission; an object on the robot is set down.

        The next call of advance returns what to do now.

        Args:
            name: Name of the delivery; empty: the whole mission.

        Raises:
            MissionError: If there is no such delivery, or it has ended.
        """
        self._refuse_if_over()
        if name:
            jobs = [self._unfinished(name)]
        else:
            jobs, self.is_cancelled = [job for job in self.jobs if job.stage not in ENDED], True
        for job in jobs:
            if job.stage in ON_ROBOT:
                name = job.delivery.object_name
                self.object_locations[name] = self.object_locations[name].dropped
            job.cancel()

    @property
    def state(self) -> ErrandState:
        """Current activity, derived from the stages of the deliveries."""
        if self._is_over:
            return self._final_state
        if self._is_measuring:
            return ErrandState.ORDERING
        if self._execution is not None and self._execution.is_searching:
            return ErrandState.SEARCHING
        return STATE_OF_STAGE.get(self.job.stage, ErrandState.READY) if self.job else ErrandState.READY

    @property
    def jobs(self) -> List[DeliveryJob]:
        """Deliveries in the order of execution."""
        return self._schedule.jobs

    @property
    def job(self) -> Optional[DeliveryJob]:
        """Delivery in progress, or the last one."""
        return self._execution.job if self._execution else None

    @property
    def place(self) -> Optional[NamedPlace]:
        """Place that the robot is at or driving to."""
        return self._execution.approach.place if self._execution and self._execution.approach else None

    @property
    def attempt(self) -> int:
        """Number of the attempt to reach that place."""
        return self._execution.approach.attempt if self._execution and self._execution.approach else 0

    @property
    def progress(self) -> float:
        """Completed share of the mission, 0 to 1."""
        done = sum(1.0 if job.stage in ENDED else job.stage.value / 5.0 for job in self.jobs)
        return done / len(self.jobs)

    def time_left(self, now: float) -> float:
        """Estimate the remaining time of the mission [s]."""
        if self._is_over:
            return 0.0
        left = self._driving_time.seconds_left(self._elapsed.update(now))
        return left + self._driving_time.seconds_for(self.jobs, self.mission, self.place)

    def _begin_next(self, now: float) -> Order:
        while True:
            self._schedule.fail_blocked()
            job = self._schedule.carried_job
            if job is None:
                waiting = self._schedule.waiting
                if not waiting or (self._schedule.has_failed and self.mission.settings.on_failure == "stop"):
                    return self._conclude()
                if not self._schedule.is_ordered and len(waiting) > 1:
                    self._is_measuring = True
                    return MeasurePathLengths(self._schedule.legs(self.mission.places))
                job = self._schedule.next_job()
            approach = self._execution.approach if self._execution else None
            self._execution = DeliveryExecution(
                job, self.mission, self.object_locations, self._driving_time, approach, self._area
            )
            self._execution.base_in_map = self.base_in_map
            order = self._execution.start(now)
            if order is not None:
                return order

    def _apply_order(self, now: float, event: Optional[Event]) -> Optional[Order]:
        if not isinstance(event, PathLengthsMeasured):
            return None
        self._is_measuring = False
        self._schedule.apply_path_lengths(event.lengths)
        return self._begin_next(now)

    def _unfinished(self, name: str) -> DeliveryJob:
        job = next((job for job in self.jobs if job.delivery.name == name), None)
        if job is None:
            raise MissionError(f"there is no delivery {name}")
        if job.stage in ENDED:
            raise MissionError(f"delivery {name} is {job.stage.name.lower()} already")
        return job

    def _conclude(self) -> FinishTask:
        failed = [job for job in self.jobs if job.stage is DeliveryStage.FAILED]
        if failed:
            first = failed[0]
            return self._end(
                first.reason if len(self.jobs) == 1 else f"{first.delivery.name}: {first.reason}"
            )
        if all(job.stage is DeliveryStage.CANCELLED for job in self.jobs):
            return self._end("cancelled")
        last = self.jobs[-1]
        return self._end(last.reason or f"delivered at place {last.delivery.destination}")

    def _end(self, reason: str) -> FinishTask:
        self._is_over, self.reason = True, self._summary(reason)
        return FinishTask(self.state is ErrandState.DELIVERED, self.reason)

    @property
    def _final_state(self) -> ErrandState:
        if self._schedule.has_failed and not self.is_cancelled:
            return ErrandState.FAILED
        if self.is_cancelled or self._lacks_cancelled:
            return ErrandState.CANCELLED
        return ErrandState.DELIVERED

    @property
    def _lacks_cancelled(self) -> bool:
        """Whether a cancelled delivery is missing: one of the mission as it was given, or all of them."""
        cancelled = {job.delivery.name for job in self.jobs if job.stage is DeliveryStage.CANCELLED}
        return bool(cancelled - self.added) or len(cancelled) == len(self.jobs)

    def _summary(self, reason: str) -> str:
        if len(self.jobs) == 1:
            return reason
        counts = [(stage, sum(job.stage is stage for job in self.jobs)) for stage in ENDED]
        ended = [f"{count} {stage.name.lower()}" for stage, count in counts[1:] if count]
        text = ", ".join([f"{counts[0][1]} of {len(self.jobs)} delivered", *ended])
        return f"{text}; {reason}" if self._schedule.has_failed else text

    def _refuse_if_over(self) -> None:
        if self._is_over:
            raise MissionError("the mission is over")

    def _place_objects(self) -> None:
        """Locate each object at the source of its first delivery, if it is known."""
        moved: Set[str] = set()
        for delivery in self.mission.deliveries:
            is_first = delivery.object_name not in moved
            moved.add(delivery.object_name)
            if not delivery.source or not is_first:
                continue
            source = self.mission.places[delivery.source]
            self.object_locations.setdefault(delivery.object_name, ObjectLocation(source.name, source.pose))
