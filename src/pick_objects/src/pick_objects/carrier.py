"""One delivery: to its object, pick it up, to where it is wanted, set it down."""

from typing import Dict, Optional, Union

from pick_objects.approach import Approach, Arrived, GivenUp, GoTo
from pick_objects.forecast import Forecast
from pick_objects.job import Job, Stage, Whereabouts
from pick_objects.mission import Mission
from planar.driving import GoalFailed, GoalReached, RobotDisplaced


class Carrier:
    """Makes the delivery of ``job``, whose stage tells how far it is: in the end DELIVERED or FAILED.

    ``approach``: the drive that it is on, or the last one, that of an earlier delivery to begin with.
    ``whereabouts`` of the objects are kept up to date, and so is the ``forecast``.
    """

    def __init__(
        self,
        job: Job,
        mission: Mission,
        whereabouts: Dict[str, Whereabouts],
        forecast: Forecast,
        approach: Optional[Approach],
    ):
        self.job, self.approach = job, approach
        self._mission, self._whereabouts, self._forecast = mission, whereabouts, forecast
        self._since, self._left = 0.0, 0

    def set_out(self, now: float) -> Optional[GoTo]:
        """The first order; None if the delivery has failed already."""
        delivery = self.job.delivery
        if self.job.stage is Stage.CARRYING:  # taken up again
            return self._go(now, Stage.CARRYING)
        if self._whereabouts[delivery.thing].place != delivery.source:
            self._fail(f"{delivery.thing} is not at {delivery.source}")
            return None
        return self._go(now, Stage.FETCHING)

    def advance(
        self, now: float, event: Union[None, GoalReached, GoalFailed, RobotDisplaced]
    ) -> Optional[GoTo]:
        """The next order, or None to carry on, or if the delivery has ended."""
        if self.job.stage in (Stage.PICKING_UP, Stage.SETTING_DOWN):
            return self._go_back(now) if isinstance(event, RobotDisplaced) else self._handle(now)
        assert self.approach is not None
        answer = self.approach.advance(now, None if isinstance(event, RobotDisplaced) else event)
        if isinstance(answer, GoTo):
            self.job.attempts += 1
            return answer
        if isinstance(answer, GivenUp):
            self._fail(answer.reason)
        return self._arrive(now) if isinstance(answer, Arrived) else None

    def _go(self, now: float, stage: Stage) -> GoTo:
        delivery, mission = self.job.delivery, self._mission
        place = mission.places[delivery.source if stage is Stage.FETCHING else delivery.destination]
        self._forecast.set_out(now, self.approach.place.pose if self.approach else None, place.pose)
        self.job.stage = stage
        self.approach = Approach(place, mission.settings, delivery.goal_timeout)
        self.job.attempts += 1
        return self.approach.start(now)

    def _arrive(self, now: float) -> Optional[GoTo]:
        self._forecast.arrive(now)
        self._since = now
        if self.job.stage is Stage.FETCHING:
            self.job.stage = Stage.PICKING_UP
            return None
        self.job.stage = Stage.SETTING_DOWN
        return self._handle(now)

    def _handle(self, now: float) -> Optional[GoTo]:
        """Picks up or sets down, which takes its time."""
        assert self.approach is not None
        delivery, settings = self.job.delivery, self._mission.settings
        is_picking_up = self.job.stage is Stage.PICKING_UP
        if now - self._since < (settings.pickup_seconds if is_picking_up else settings.dropoff_seconds):
            return None
        if is_picking_up:
            where = self._whereabouts[delivery.thing]
            self._whereabouts[delivery.thing] = Whereabouts(None, where.pose, is_carried=True)
            return self._go(now, Stage.CARRYING)
        pose = GoTo(self.approach.place, self.approach.attempt).pose
        self._whereabouts[delivery.thing] = Whereabouts(delivery.destination, pose)
        self.job.stage = Stage.DELIVERED
        return None

    def _go_back(self, now: float) -> Optional[GoTo]:
        """To where the robot was about to pick up or set down, as often as places are tried at most."""
        assert self.approach is not None
        self._left += 1
        if self._left >= self._mission.settings.attempts:
            self._fail(
                f"place {self.approach.place.name}: carried away, or in doubt of it, {self._left} times"
            )
            return None
        return self._go(now, Stage.FETCHING if self.job.stage is Stage.PICKING_UP else Stage.CARRYING)

    def _fail(self, reason: str) -> None:
        self.job.fail(reason)
        thing = self.job.delivery.thing
        self._whereabouts[thing] = self._whereabouts[thing].left
