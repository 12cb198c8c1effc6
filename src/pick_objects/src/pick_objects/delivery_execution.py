"""One delivery: drive to the object, pick it up, drive to the destination, set it down."""

from typing import Dict, Optional, Union

from pick_objects.approach import DriveToPlace, PlaceApproach, PlaceReached, PlaceUnreachable
from pick_objects.driving_time import DrivingTimeEstimator
from pick_objects.job import DeliveryJob, DeliveryStage, ObjectLocation
from pick_objects.mission import Mission
from planar.driving import GoalFailed, GoalReached, RobotDisplaced


class DeliveryExecution:
    """Carries out the delivery of ``job``, whose stage ends as DELIVERED or FAILED.

    Args:
        job: Delivery and its stage, updated in place.
        mission: Mission that it belongs to.
        object_locations: Location of each object, updated in place.
        driving_time: Estimator of driving times, updated in place.
        approach: Approach of the delivery before, from where the robot starts.
    """

    def __init__(
        self,
        job: DeliveryJob,
        mission: Mission,
        object_locations: Dict[str, ObjectLocation],
        driving_time: DrivingTimeEstimator,
        approach: Optional[PlaceApproach],
    ):
        self.job, self.approach = job, approach
        self._mission, self._object_locations, self._driving_time = mission, object_locations, driving_time
        self._since, self._displacements = 0.0, 0

    def start(self, now: float) -> Optional[DriveToPlace]:
        """Return the first order; None if the delivery has failed already."""
        delivery = self.job.delivery
        if self.job.stage is DeliveryStage.CARRYING:  # resumed after a restart
            return self._go(now, DeliveryStage.CARRYING)
        if self._object_locations[delivery.object_name].place != delivery.source:
            self._fail(f"{delivery.object_name} is not at {delivery.source}")
            return None
        return self._go(now, DeliveryStage.FETCHING)

    def advance(
        self, now: float, event: Union[None, GoalReached, GoalFailed, RobotDisplaced]
    ) -> Optional[DriveToPlace]:
        """Return the next order; None while nothing changes, or when the delivery has ended."""
        if self.job.stage in (DeliveryStage.PICKING_UP, DeliveryStage.SETTING_DOWN):
            return self._go_back(now) if isinstance(event, RobotDisplaced) else self._pick_up_or_set_down(now)
        assert self.approach is not None
        answer = self.approach.advance(now, None if isinstance(event, RobotDisplaced) else event)
        if isinstance(answer, DriveToPlace):
            self.job.attempts += 1
            return answer
        if isinstance(answer, PlaceUnreachable):
            self._fail(answer.reason)
        return self._arrive(now) if isinstance(answer, PlaceReached) else None

    def _go(self, now: float, stage: DeliveryStage) -> DriveToPlace:
        delivery, mission = self.job.delivery, self._mission
        place = mission.places[delivery.source if stage is DeliveryStage.FETCHING else delivery.destination]
        self._driving_time.on_departure(now, self.approach.place.pose if self.approach else None, place.pose)
        self.job.stage = stage
        self.approach = PlaceApproach(place, mission.settings, delivery.goal_timeout)
        self.job.attempts += 1
        return self.approach.start(now)

    def _arrive(self, now: float) -> Optional[DriveToPlace]:
        self._driving_time.on_arrival(now)
        self._since = now
        if self.job.stage is DeliveryStage.FETCHING:
            self.job.stage = DeliveryStage.PICKING_UP
            return None
        self.job.stage = DeliveryStage.SETTING_DOWN
        return self._pick_up_or_set_down(now)

    def _pick_up_or_set_down(self, now: float) -> Optional[DriveToPlace]:
        """Finish picking up or setting down once its time is over."""
        assert self.approach is not None
        delivery, settings = self.job.delivery, self._mission.settings
        is_picking_up = self.job.stage is DeliveryStage.PICKING_UP
        if now - self._since < (settings.pickup_seconds if is_picking_up else settings.dropoff_seconds):
            return None
        if is_picking_up:
            where = self._object_locations[delivery.object_name]
            self._object_locations[delivery.object_name] = ObjectLocation(None, where.pose, is_carried=True)
            return self._go(now, DeliveryStage.CARRYING)
        pose = DriveToPlace(self.approach.place, self.approach.attempt).pose
        self._object_locations[delivery.object_name] = ObjectLocation(delivery.destination, pose)
        self.job.stage = DeliveryStage.DELIVERED
        return None

    def _go_back(self, now: float) -> Optional[DriveToPlace]:
        """Return to the place after a displacement, at most as often as places are tried."""
        assert self.approach is not None
        self._displacements += 1
        if self._displacements >= self._mission.settings.attempts:
            self._fail(
                f"place {self.approach.place.name}: the robot was moved away, or its pose became uncertain, "
                f"{self._displacements} times"
            )
            return None
        return self._go(
            now,
            DeliveryStage.FETCHING if self.job.stage is DeliveryStage.PICKING_UP else DeliveryStage.CARRYING,
        )

    def _fail(self, reason: str) -> None:
        self.job.fail(reason)
        object_name = self.job.delivery.object_name
        self._object_locations[object_name] = self._object_locations[object_name].dropped
