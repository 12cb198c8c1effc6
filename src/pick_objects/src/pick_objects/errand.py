"""The errand: carries a mission out, one delivery after the other."""

from dataclasses import dataclass
from typing import Dict, List, Optional, Set, Tuple, Union

from pick_objects.approach import Approach, Arrived, GivenUp, GoTo
from pick_objects.forecast import Forecast
from pick_objects.job import ENDED, FINAL_STATES, ErrandState, Job, Stage, Whereabouts
from pick_objects.mission import Delivery, Mission, MissionError
from pick_objects.ordering import shortest_order
from planar import Pose2
from planar.driving import Finish, GoalReached, GoalRefused
from planar.maps.places import Place

NO_WAY = 1e6
"""Metres that a way counts which no planner has found: it is left for last."""


@dataclass(frozen=True)
class MeasureWays:
    """Order: find out how long these ways are. A way from None begins where the robot is."""

    ways: Tuple[Tuple[Optional[Pose2], Pose2], ...]


@dataclass(frozen=True)
class WaysMeasured:
    """Event: the lengths of the ways of the last order, metres; None where there is no way."""

    lengths: Tuple[Optional[float], ...]


Order = Union[GoTo, MeasureWays, Finish]
Event = Union[GoalReached, GoalRefused, WaysMeasured]


class Errand:
    """A mission under way, told the time and what happened, answering what to do next.

    ``jobs``: the deliveries in the order in which they are carried out. ``whereabouts``: of each object.
    """

    def __init__(self, mission: Mission):
        self.mission = mission
        self.state = ErrandState.READY
        self.jobs: List[Job] = [Job(delivery) for delivery in mission.deliveries]
        self.whereabouts: Dict[str, Whereabouts] = {}
        self.reason = ""
        self._note_objects()
        self._job: Optional[Job] = None
        self._approach: Optional[Approach] = None
        self._since = 0.0
        self._is_ordered = mission.settings.order != "shortest"
        self._is_cancelled = False
        self._forecast = Forecast()

    def advance(self, now: float, event: Optional[Event] = None) -> Optional[Order]:
        """The next order, or None to carry on. ``now``: seconds; ``event``: what came of the last order."""
        if self.state in FINAL_STATES:
            return None
        if self._is_cancelled:
            return self._stop_all()
        if self.state is ErrandState.READY:
            return self._begin_next(now)
        if self.state is ErrandState.ORDERING:
            return self._take_order(now, event)
        assert self._job is not None
        if self._job.stage is Stage.CANCELLED:
            self._leave_object()
            return self._begin_next(now)
        if self.state in (ErrandState.PICKING_UP, ErrandState.SETTING_DOWN):
            return self._handle(now)
        return self._drive(now, event)

    def add(self, delivery: Delivery) -> Delivery:
        """Adds a delivery to those that wait; returns it with its name. Raises MissionError."""
        self._refuse_if_over()
        self.mission = self.mission.with_delivery(delivery)
        added = self.mission.deliveries[-1]
        self.jobs.append(Job(added))
        self._note_objects()
        self._is_ordered = self.mission.settings.order != "shortest"
        return added

    def cancel(self, name: str = "") -> None:
        """Cancels the delivery of that name, or the whole mission, at the next call of advance.

        Raises MissionError.
        """
        self._refuse_if_over()
        if not name:
            self._is_cancelled = True
            return
        job = next((job for job in self.jobs if job.delivery.name == name), None)
        if job is None:
            raise MissionError(f"there is no delivery {name}")
        if job.stage in ENDED:
            raise MissionError(f"delivery {name} is {job.stage.name.lower()} already")
        job.stage, job.reason = Stage.CANCELLED, "cancelled"

    @property
    def job(self) -> Optional[Job]:
        """The delivery in progress, or the last one."""
        return self._job

    @property
    def place(self) -> Optional[Place]:
        """The place that the robot is at or on its way to."""
        return self._approach.place if self._approach else None

    @property
    def attempt(self) -> int:
        """How often the robot was sent to that place."""
        return self._approach.attempt if self._approach else 0

    @property
    def progress(self) -> float:
        """The share of the mission that is over, 0 to 1."""
        done = sum(1.0 if job.stage in ENDED else job.stage.value / 5.0 for job in self.jobs)
        return done / len(self.jobs)

    def time_left(self, now: float) -> float:
        """Seconds that the rest of the mission is estimated to take."""
        if self.state in FINAL_STATES:
            return 0.0
        settings, places, where = self.mission.settings, self.mission.places, self.place
        left = 0.0
        for job in self.jobs:
            if job.stage in ENDED:
                continue
            source, destination = places[job.delivery.source], places[job.delivery.destination]
            if job.stage.value < Stage.PICKING_UP.value and where:
                left += self._forecast.seconds_between(where.pose, source.pose)
            if job.stage.value < Stage.CARRYING.value:
                left += settings.pickup_seconds
                left += self._forecast.seconds_between(source.pose, destination.pose)
            left += settings.dropoff_seconds
            where = destination
        return left + self._forecast.seconds_left(now)

    def _begin_next(self, now: float) -> Order:
        self._give_up_hopeless()
        waiting = [job for job in self.jobs if job.stage is Stage.WAITING]
        if not waiting or (self._has_failed and self.mission.settings.on_failure == "stop"):
            return self._conclude()
        if not self._is_ordered and len(waiting) > 1:
            self.state = ErrandState.ORDERING
            return MeasureWays(self._ways_of(waiting))
        self._job = next(job for job in waiting if not self._before(job))
        delivery = self._job.delivery
        if self.whereabouts[delivery.thing].place != delivery.source:
            return self._fail(now, f"{delivery.thing} is not at {delivery.source}")
        return self._go(now, ErrandState.GOING_TO_PICKUP)

    def _before(self, job: Job) -> List[Job]:
        """The deliveries under way or waiting that must come before this one."""
        known = self.mission.deliveries
        earlier = known[: known.index(job.delivery)]
        same_thing = {delivery.name for delivery in earlier if delivery.thing == job.delivery.thing}
        names = same_thing | set(job.delivery.after)
        return [other for other in self.jobs if other.delivery.name in names and other.stage not in ENDED]

    def _give_up_hopeless(self) -> None:
        """Fails what waits for deliveries that will never be made."""
        stages = {job.delivery.name: job.stage for job in self.jobs}
        for delivery in self.mission.deliveries:
            lost = [name for name in delivery.after if stages[name] in (Stage.FAILED, Stage.CANCELLED)]
            if lost and stages[delivery.name] is Stage.WAITING:
                job = next(job for job in self.jobs if job.delivery is delivery)
                job.stage, job.reason = Stage.FAILED, f"{lost[0]} was not delivered"
                stages[delivery.name] = job.stage

    def _ways_of(self, waiting: List[Job]) -> Tuple[Tuple[Optional[Pose2], Pose2], ...]:
        """From the robot to each source, then from each destination to each source."""
        places = self.mission.places
        sources = [places[job.delivery.source].pose for job in waiting]
        ends = [places[job.delivery.destination].pose for job in waiting]
        return tuple((start, source) for start in (None, *ends) for source in sources)

    def _take_order(self, now: float, event: Optional[Event]) -> Optional[Order]:
        if not isinstance(event, WaysMeasured):
            return None
        waiting = [job for job in self.jobs if job.stage is Stage.WAITING]
        count = len(waiting)
        self._is_ordered = len(event.lengths) == count * (count + 1)
        if self._is_ordered:  # else one was cancelled or added meanwhile: once more
            lengths = [NO_WAY if length is None else length for length in event.lengths]
            rows = [lengths[i * count : (i + 1) * count] for i in range(count + 1)]
            before: List[Set[int]] = [
                {waiting.index(other) for other in self._before(job)} for job in waiting
            ]
            best = [waiting[i] for i in shortest_order(rows[0], rows[1:], before)]
            self.jobs = [job for job in self.jobs if job.stage is not Stage.WAITING] + best
        return self._begin_next(now)

    def _go(self, now: float, state: ErrandState) -> GoTo:
        assert self._job is not None
        delivery, settings = self._job.delivery, self.mission.settings
        is_fetching = state is ErrandState.GOING_TO_PICKUP
        place = self.mission.places[delivery.source if is_fetching else delivery.destination]
        self._forecast.set_out(now, self.place.pose if self.place else None, place.pose)
        self.state = state
        self._job.stage = Stage.FETCHING if is_fetching else Stage.CARRYING
        self._approach = Approach(place, settings, delivery.goal_timeout)
        self._job.attempts += 1
        return self._approach.start(now)

    def _drive(self, now: float, event: Optional[Event]) -> Optional[Order]:
        assert self._job is not None and self._approach is not None
        if isinstance(event, WaysMeasured):
            event = None
        answer = self._approach.advance(now, event)
        if isinstance(answer, GoTo):
            self._job.attempts += 1
            return answer
        if isinstance(answer, GivenUp):
            return self._fail(now, answer.reason)
        return self._arrive(now) if isinstance(answer, Arrived) else None

    def _arrive(self, now: float) -> Optional[Order]:
        assert self._job is not None
        self._forecast.arrive(now)
        self._since = now
        if self.state is ErrandState.GOING_TO_PICKUP:
            self.state, self._job.stage = ErrandState.PICKING_UP, Stage.PICKING_UP
            return None
        self.state, self._job.stage = ErrandState.SETTING_DOWN, Stage.SETTING_DOWN
        return self._handle(now)

    def _handle(self, now: float) -> Optional[Order]:
        """Picks up or sets down, which takes its time."""
        assert self._job is not None and self._approach is not None
        delivery, settings = self._job.delivery, self.mission.settings
        is_picking_up = self.state is ErrandState.PICKING_UP
        if now - self._since < (settings.pickup_seconds if is_picking_up else settings.dropoff_seconds):
            return None
        where = self.whereabouts[delivery.thing]
        if is_picking_up:
            self.whereabouts[delivery.thing] = Whereabouts(None, where.pose, is_carried=True)
            return self._go(now, ErrandState.GOING_TO_DROPOFF)
        pose = GoTo(self._approach.place, self._approach.attempt).pose
        self.whereabouts[delivery.thing] = Whereabouts(delivery.destination, pose)
        self._job.stage = Stage.DELIVERED
        return self._begin_next(now)

    def _fail(self, now: float, reason: str) -> Order:
        assert self._job is not None
        self._job.stage, self._job.reason = Stage.FAILED, reason
        self._leave_object()
        return self._begin_next(now)

    def _leave_object(self) -> None:
        """An object on the robot is set down where the robot stands."""
        for thing, where in self.whereabouts.items():
            if where.is_carried:
                self.whereabouts[thing] = Whereabouts(None, where.pose)

    def _stop_all(self) -> Finish:
        for job in self.jobs:
            if job.stage not in ENDED:
                job.stage, job.reason = Stage.CANCELLED, "cancelled"
        self._leave_object()
        return self._end(ErrandState.CANCELLED, False, self._summary("cancelled"))

    def _conclude(self) -> Finish:
        failed = [job for job in self.jobs if job.stage is Stage.FAILED]
        if failed:
            first = failed[0]
            reason = first.reason if len(self.jobs) == 1 else f"{first.delivery.name}: {first.reason}"
            return self._end(ErrandState.FAILED, False, self._summary(reason))
        if all(job.stage is Stage.CANCELLED for job in self.jobs):
            return self._end(ErrandState.CANCELLED, False, self._summary("cancelled"))
        destination = self.jobs[-1].delivery.destination
        return self._end(ErrandState.DELIVERED, True, self._summary(f"delivered at place {destination}"))

    def _summary(self, reason: str) -> str:
        if len(self.jobs) == 1:
            return reason
        counts = [(stage, sum(job.stage is stage for job in self.jobs)) for stage in ENDED]
        told = [f"{count} {stage.name.lower()}" for stage, count in counts[1:] if count]
        text = ", ".join([f"{counts[0][1]} of {len(self.jobs)} delivered", *told])
        return f"{text}; {reason}" if self._has_failed else text

    def _end(self, state: ErrandState, success: bool, reason: str) -> Finish:
        self.state, self.reason = state, reason
        return Finish(success, reason)

    @property
    def _has_failed(self) -> bool:
        return any(job.stage is Stage.FAILED for job in self.jobs)

    def _refuse_if_over(self) -> None:
        if self.state in FINAL_STATES:
            raise MissionError("the mission is over")

    def _note_objects(self) -> None:
        """An object is where the first delivery of it begins."""
        for delivery in self.mission.deliveries:
            source = self.mission.places[delivery.source]
            self.whereabouts.setdefault(delivery.thing, Whereabouts(source.name, source.pose))
