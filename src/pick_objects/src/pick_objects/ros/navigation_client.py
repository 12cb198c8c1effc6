"""Client of move_base: converts orders to goals and plans, and their outcomes to events."""

from typing import Optional, Union

import rospy
from nav_msgs.msg import Odometry
from std_msgs.msg import Float32

from pick_objects.approach import DriveToPlace
from pick_objects.arrival import ArrivalCheck, RecentScanFit, ResendGoal
from pick_objects.errand import MeasurePathLengths, PathLengthsMeasured
from planar import Pose2
from planar.driving import GoalFailed, GoalReached, RobotDisplaced
from planar_ros.calls.move_base import MoveBaseClient
from planar_ros.calls.services import ServiceError
from planar_ros.messages.conversion import pose2_from_msg
from planar_ros.messages.validation import subscribe

# Fit of each scan, published by amcl_lite; the official amcl does not publish it.
QUALITY_TOPIC = "amcl/localization_quality"
# Age after which a fit is ignored [s].
MAX_FIT_AGE = 2.0


class NavigationClient:
    """Drives with move_base, one order at a time.

    Args:
        frame_id: Frame of the goals.
    """

    def __init__(self, frame_id: str):
        self.move_base = MoveBaseClient(frame_id)
        self.move_base.cancel_on_shutdown()
        self._order: Optional[DriveToPlace] = None
        self._arrival = ArrivalCheck(Pose2())
        self._fit, self._fit_at = RecentScanFit(), rospy.Time(0)
        self._odometry: Optional[Pose2] = None
        rospy.Subscriber(QUALITY_TOPIC, Float32, self._on_fit, queue_size=1)
        subscribe("odom", Odometry, self._on_odometry, queue_size=1)

    @property
    def base_in_map(self) -> Pose2:
        """Estimated pose of the robot; the origin before it is known."""
        return self.move_base.robot or Pose2()

    def send(self, order: DriveToPlace) -> None:
        """Send the goal of an order."""
        if order.attempt > 1:
            place, pose = order.place.name, order.pose
            rospy.logwarn("place %s: attempt %d, at (%g, %g)", place, order.attempt, pose.x, pose.y)
        self._order, self._arrival = order, ArrivalCheck(order.pose)
        self.move_base.send(order.pose)

    def event(self) -> Union[None, GoalReached, GoalFailed, RobotDisplaced]:
        """Return the outcome of the last goal once; None while the robot drives or stands there."""
        outcome = self.move_base.outcome()
        if self._order is None:
            return None
        reported = None if outcome is None else outcome.event
        event = self._arrival.check(
            reported, self.base_in_map, self._recent_fit, rospy.get_time(), self._odometry
        )
        place = self._order.place.name
        if isinstance(event, ResendGoal):
            rospy.logwarn("place %s: scans contradict the estimated pose, the goal is sent again", place)
            self.move_base.send(self._order.pose)
            return None
        if isinstance(event, RobotDisplaced):
            rospy.logwarn(
                "place %s: the robot has moved since its arrival, or scans contradict its pose", place
            )
        if isinstance(event, GoalFailed):
            rospy.logwarn("place %s: %s", place, event.reason)
        return event

    def measure(self, order: MeasurePathLengths) -> PathLengthsMeasured:
        """Return the lengths of move_base's plans, or of straight lines if it does not plan."""
        try:
            return PathLengthsMeasured(
                tuple(self.move_base.plan_length(start, end) for start, end in order.legs)
            )
        except ServiceError as error:
            rospy.logwarn("the deliveries are ordered by straight-line distances: %s", error)
            lines = ((start or self.base_in_map).distance_to(end) for start, end in order.legs)
            return PathLengthsMeasured(tuple(lines))

    @property
    def _recent_fit(self) -> Optional[float]:
        """Worst fit of the last scans; None if none was published lately."""
        is_fresh = abs((rospy.Time.now() - self._fit_at).to_sec()) < MAX_FIT_AGE
        return self._fit.minimum if is_fresh else None

    def _on_fit(self, message: Float32) -> None:
        self._fit.add(message.data)
        self._fit_at = rospy.Time.now()

    def _on_odometry(self, message: Odometry) -> None:
        self._odometry = pose2_from_msg(message.pose.pose)
