"""One delivery: drive to the object, or search it, pick it up, drive to the destination, set it down."""

from typing import Dict, Optional, Union

from pick_objects.approach import DriveToPlace, PlaceApproach, PlaceReached, PlaceUnreachable
from pick_objects.driving_time import DrivingTimeEstimator
from pick_objects.job import DeliveryJob, DeliveryStage, ObjectLocation
from pick_objects.mission import Mission
from pick_objects.search.area import SearchArea
from pick_objects.search.execution import (
    LookForObject,
    LookTaken,
    ObjectFound,
    ObjectNotFound,
    SearchExecution,
)
from pick_objects.search.execution import Outcome as SearchOutcome
from pick_objects.search.object_search import ObjectSearch
from planar import Pose2
from planar.driving import GoalFailed, GoalReached, RobotDisplaced
from planar.maps.places import NamedPlace

Order = Union[DriveToPlace, LookForObject]


class DeliveryExecution:
    """Carries out the delivery of ``job``, whose stage ends as DELIVERED or FAILED.

    Args:
        job: Delivery and its stage, updated in place.
        mission: Mission that it belongs to.
        object_locations: Location of each object, updated in place.
        driving_time: Estimator of driving times, updated in place.
        approach: Approach of the delivery before, from where the robot starts.
        area: Where objects can be searched; None if there is no semantic map.

    Attributes:
        base_in_map: Estimated pose of the robot; set it before each call.
    """

    def __init__(
        self,
        job: DeliveryJob,
        mission: Mission,
        object_locations: Dict[str, ObjectLocation],
        driving_time: DrivingTimeEstimator,
        approach: Optional[PlaceApproach],
        area: Optional[SearchArea] = None,
    ):
        self.job, self.approach, self.base_in_map = job, approach, Pose2()
        self._area = area
        self._search: Optional[SearchExecution] = None
        self._source: Optional[NamedPlace] = None
        self._mission, self._object_locations, self._driving_time = mission, object_locations, driving_time
        self._since, self._displacements = 0.0, 0

    @property
    def is_searching(self) -> bool:
        """Whether the object is being searched."""
        return self._search is not None

    def start(self, now: float) -> Optional[Order]:
        """Return the first order; None if the delivery has failed already."""
        delivery = self.job.delivery
        if self.job.stage is DeliveryStage.CARRYING:  # resumed after a restart
            return self._go(now, DeliveryStage.CARRYING)
        location = self._object_locations.get(delivery.object_name)
        if delivery.source and (location is None or location.place != delivery.source):
            self._fail(f"{delivery.object_name} is not at {delivery.source}")
            return None
        if location is None:
            return self._begin_search(now)
        if not delivery.destination:
            where = f"at {location.place}" if location.place else "where the robot left it"
            self.job.stage, self.job.reason = DeliveryStage.DELIVERED, f"{delivery.object_name} is {where}"
            return None
        if not delivery.source:
            self._source = self._place_of(delivery.object_name, location)
        return self._go(now, DeliveryStage.FETCHING)

    def advance(
        self, now: float, event: Union[None, GoalReached, GoalFailed, RobotDisplaced, LookTaken]
    ) -> Optional[Order]:
        """Return the next order; None while nothing changes, or when the delivery has ended."""
        if self.job.stage in (DeliveryStage.PICKING_UP, DeliveryStage.SETTING_DOWN):
            return self._go_back(now) if isinstance(event, RobotDisplaced) else self._pick_up_or_set_down(now)
        event = None if isinstance(event, RobotDisplaced) else event
        if self._search is not None:
            return self._follow_search(now, self._search.advance(now, event, self.base_in_map))
        assert self.approach is not None
        answer = self.approach.advance(now, None if isinstance(event, LookTaken) else event)
        if isinstance(answer, DriveToPlace):
            self.job.attempts += 1
            return answer
        if isinstance(answer, PlaceUnreachable):
            self._fail(answer.reason)
        return self._arrive(now) if isinstance(answer, PlaceReached) else None

    def _begin_search(self, now: float) -> Optional[Order]:
        name = self.job.delivery.object_name
        if self._area is None:
            self._fail(f"it is not known where {name} is, and there is no semantic map to search it by")
            return None
        self.job.stage = DeliveryStage.FETCHING
        search = ObjectSearch(self._area, name)
        self._search = SearchExecution(search, self._mission.settings)
        return self._follow_search(now, self._search.start(now, self.base_in_map))

    def _follow_search(self, now: float, outcome: SearchOutcome) -> Optional[Order]:
        assert self._search is not None
        if isinstance(outcome, ObjectNotFound):
            self._search = None
            self._fail(outcome.reason)
            return None
        if isinstance(outcome, ObjectFound):
            self.approach, self._search = self._search.approach, None
            return self._fetch_found(now, outcome)
        if isinstance(outcome, DriveToPlace):
            self.approach = self._search.approach
            self.job.attempts += 1
        return outcome

    def _fetch_found(self, now: float, found: ObjectFound) -> Optional[Order]:
        """Drive to an object that was found, unless it was only to be found."""
        name = self.job.delivery.object_name
        self._object_locations[name] = ObjectLocation(found.furniture, Pose2(*found.seen_at))
        if not self.job.delivery.destination:
            self.job.stage, self.job.reason = DeliveryStage.DELIVERED, f"{name} is {found.where}"
            return None
        self._source = found.place
        return self._go(now, DeliveryStage.FETCHING)

    def _place_of(self, name: str, location: ObjectLocation) -> NamedPlace:
        """Return where to pick up an object whose location is known."""
        if location.place is not None and location.place in self._mission.places:
            return self._mission.places[location.place]
        where = location.pose
        pose = self._area.pose_near(where.x, where.y, self.base_in_map) if self._area else None
        return NamedPlace(name, pose or where)

    def _go(self, now: float, stage: DeliveryStage) -> DriveToPlace:
        delivery, mission = self.job.delivery, self._mission
        name = delivery.source if stage is DeliveryStage.FETCHING else delivery.destination
        is_fetching = stage is DeliveryStage.FETCHING
        place = (self._source if is_fetching else None) or mission.places[name]
        self._driving_time.on_departure(now, self.approach.place.pose if self.approach else None, place.pose)
        self.job.stage = stage
        self.approach = PlaceApproach(place, mission.settings, delivery.goal_timeout)
        self.job.attempts += 1
        return self.approach.start(now)

    def _arrive(self, now: float) -> Optional[Order]:
        self._driving_time.on_arrival(now)
        self._since = now
        if self.job.stage is DeliveryStage.FETCHING:
            self.job.stage = DeliveryStage.PICKING_UP
            return None
        self.job.stage = DeliveryStage.SETTING_DOWN
        return self._pick_up_or_set_down(now)

    def _pick_up_or_set_down(self, now: float) -> Optional[Order]:
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

    def _go_back(self, now: float) -> Optional[Order]:
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
        name = self.job.delivery.object_name
        if name in self._object_locations:
            self._object_locations[name] = self._object_locations[name].dropped
