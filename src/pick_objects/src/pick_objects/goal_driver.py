"""Goal driver: carries out the orders of an errand with move_base, over ROS and without it."""

from typing import Callable, Optional, Protocol, Tuple, Union

from pick_objects.approach import DriveToPlace
from pick_objects.arrival import ArrivalCheck, RecentScanFit, ResendGoal
from pick_objects.errand import MeasurePathLengths, Order, PathLengthsMeasured
from pick_objects.search.execution import LookForObject, LookTaken
from planar import PlanarError, Pose2
from planar.detection import Detections
from planar.driving import DriveOutcome, GoalFailed, GoalReached, RobotDisplaced

# Age after which a fit is ignored, and time after which a look without an image has failed [s].
MAX_FIT_AGE, LOOK_TIMEOUT = 2.0, 5.0


class MoveBasePort(Protocol):
    """What the goal driver needs of move_base: its action and its plans.

    Attributes:
        robot: Robot pose in the map from the latest feedback; None before the first.
    """

    robot: Optional[Pose2]

    def send(self, goal: Pose2) -> None:
        """Send a goal, which replaces any earlier one."""

    def outcome(self) -> Optional[DriveOutcome]:
        """Return the outcome of the last goal once; None while it is active and afterwards."""

    def plan_length(self, start: Optional[Pose2], end: Pose2) -> Optional[float]:
        """Return the length of a plan from ``start``, or from the robot, to ``end`` [m]; None without one.

        Raises:
            PlanarError: Plans are not available.
        """


class GoalDriver:
    """Sends goals, checks arrivals, and sends a goal again if the robot was not where it seemed to be.

    Args:
        move_base: Client of move_base.
        log: Called with a warning for people.

    Attributes:
        odometry: Latest pose in the odometry frame; None before the first.
    """

    def __init__(self, move_base: MoveBasePort, log: Callable[[str], None] = lambda text: None):
        self._move_base, self._log = move_base, log
        self.odometry: Optional[Pose2] = None
        self._order: Optional[DriveToPlace] = None
        self._arrival = ArrivalCheck(Pose2())
        self._fit, self._fit_at = RecentScanFit(), -MAX_FIT_AGE
        self._look: Optional[LookForObject] = None
        self._look_since: Optional[float] = None
        self._image: Optional[Tuple[float, Detections]] = None

    @property
    def base_in_map(self) -> Pose2:
        """Estimated pose of the robot; the origin before it is known."""
        return self._move_base.robot or Pose2()

    def add_fit(self, now: float, fit: float) -> None:
        """Add how well a scan fits the map at the estimated pose.

        Args:
            now: Time [s].
            fit: Probability, as ``RecentScanFit``.
        """
        self._fit.add(fit)
        self._fit_at = now

    def add_detections(self, stamp: float, detections: Detections) -> None:
        """Add what the detector reported of one image.

        Args:
            stamp: Time of the image [s].
            detections: All objects that it shows, in the base frame.
        """
        self._image = stamp, detections

    def carry_out(self, order: Optional[Order]) -> Optional[PathLengthsMeasured]:
        """Carry out an order of the errand.

        Returns:
            Event that the errand has to be advanced with at once; None if there is none.
        """
        if isinstance(order, DriveToPlace):
            self._look = None
            self._send(order)
        elif isinstance(order, LookForObject):
            self._look, self._look_since = order, None
        return self._measure(order) if isinstance(order, MeasurePathLengths) else None

    def discard_order(self) -> None:
        """Discard the last order: no further event of it is reported."""
        self._order = self._look = None

    def event(self, now: float) -> Union[None, GoalReached, GoalFailed, RobotDisplaced, LookTaken]:
        """Return the outcome of the last order once; None while the robot drives or stands there.

        Args:
            now: Time [s].
        """
        outcome = self._move_base.outcome()
        if self._order is None:
            return None
        if self._look is not None:
            return self._evaluate_look(self._look, now)
        reported = None if outcome is None else outcome.event
        fit = self._fit.minimum if abs(now - self._fit_at) < MAX_FIT_AGE else None
        event = self._arrival.check(reported, self.base_in_map, fit, now, self.odometry)
        place = self._order.place.name
        if isinstance(event, ResendGoal):
            self._log(f"place {place}: scans contradict the estimated pose, the goal is sent again")
            self._move_base.send(self._order.pose)
            return None
        if isinstance(event, RobotDisplaced):
            self._log(f"place {place}: the robot has moved since its arrival, or scans contradict its pose")
        if isinstance(event, GoalFailed):
            self._log(f"place {place}: {event.reason}")
        return event

    def _evaluate_look(self, look: LookForObject, now: float) -> Optional[LookTaken]:
        """Return what the first image after the order shows; None before it has come."""
        if self._look_since is None:
            self._look_since = now
        base = self.base_in_map
        if self._image is None or self._image[0] <= self._look_since:
            if now - self._look_since <= LOOK_TIMEOUT:
                return None
            self._look = None
            return LookTaken(base, problem=f"no image of the object detector within {LOOK_TIMEOUT:g} s")
        self._look = None
        seen = [base @ Pose2(each.x, each.y) for each in self._image[1] if each.name == look.name]
        return LookTaken(base, (seen[0].x, seen[0].y) if seen else None)

    def _send(self, order: DriveToPlace) -> None:
        if order.attempt > 1:
            place, pose = order.place.name, order.pose
            self._log(f"place {place}: attempt {order.attempt}, at ({pose.x:g}, {pose.y:g})")
        self._order, self._arrival = order, ArrivalCheck(order.pose)
        self._move_base.send(order.pose)

    def _measure(self, order: MeasurePathLengths) -> PathLengthsMeasured:
        """Return the lengths of move_base's plans, or of straight lines if it does not plan."""
        try:
            return PathLengthsMeasured(
                tuple(self._move_base.plan_length(start, end) for start, end in order.legs)
            )
        except PlanarError as error:
            self._log(f"the deliveries are ordered by straight-line distances: {error}")
            lines = ((start or self.base_in_map).distance_to(end) for start, end in order.legs)
            return PathLengthsMeasured(tuple(lines))
