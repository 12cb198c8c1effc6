"""Orders become goals and plans of move_base, what comes of them becomes events."""

from typing import Optional, Union

import rospy
from std_msgs.msg import Float32

from pick_objects.approach import DriveToPlace
from pick_objects.arrival import ArrivalCheck, RecentScanFit, ResendGoal
from pick_objects.errand import MeasurePathLengths, PathLengthsMeasured
from planar import Pose2
from planar.driving import GoalFailed, GoalReached, RobotDisplaced
from planar_ros.calls.move_base import MoveBaseClient
from planar_ros.calls.services import ServiceError

# Who localizes the robot tells here how well each scan fits; the official amcl does not.
QUALITY_TOPIC = "amcl/localization_quality"
# Seconds after which what was told of a scan means nothing any more.
STALE = 2.0


class NavigationClient:
    """Has move_base drive, one order at a time."""

    def __init__(self, frame_id: str):
        self.move_base = MoveBaseClient(frame_id)
        self.move_base.cancel_at_end()
        self._order: Optional[DriveToPlace] = None
        self._arrival = ArrivalCheck(Pose2())
        self._fit, self._fit_at = RecentScanFit(), rospy.Time(0)
        rospy.Subscriber(QUALITY_TOPIC, Float32, self._keep_fit, queue_size=1)

    @property
    def base_in_map(self) -> Pose2:
        return self.move_base.robot or Pose2()

    def send(self, order: DriveToPlace) -> None:
        if order.attempt > 1:
            place, pose = order.place.name, order.pose
            rospy.logwarn("place %s: attempt %d, at (%g, %g)", place, order.attempt, pose.x, pose.y)
        self._order, self._arrival = order, ArrivalCheck(order.pose)
        self.move_base.send(order.pose)

    def event(self) -> Union[None, GoalReached, GoalFailed, RobotDisplaced]:
        """What came of the last goal, told once; None while it is pursued, or the robot stands there."""
        outcome = self.move_base.outcome()
        if self._order is None:
            return None
        told = None if outcome is None else outcome.event
        event = self._arrival.check(told, self.base_in_map, self._recent_fit, rospy.get_time())
        place = self._order.place.name
        if isinstance(event, ResendGoal):
            rospy.logwarn("place %s: the robot may be elsewhere, and is sent there again", place)
            self.move_base.send(self._order.pose)
            return None
        if isinstance(event, RobotDisplaced):
            rospy.logwarn("place %s: the robot may have been carried away", place)
        if isinstance(event, GoalFailed):
            rospy.logwarn("place %s: %s", place, event.reason)
        return event

    def measure(self, order: MeasurePathLengths) -> PathLengthsMeasured:
        """The lengths of move_base's plans; straight lines if it makes no plans."""
        try:
            return PathLengthsMeasured(
                tuple(self.move_base.plan_length(start, end) for start, end in order.ways)
            )
        except ServiceError as error:
            rospy.logwarn("the order of the deliveries goes by straight lines: %s", error)
            lines = ((start or self.base_in_map).distance_to(end) for start, end in order.ways)
            return PathLengthsMeasured(tuple(lines))

    @property
    def _recent_fit(self) -> Optional[float]:
        """How well the last scans fit the map; None if nobody has told lately."""
        is_fresh = abs((rospy.Time.now() - self._fit_at).to_sec()) < STALE
        return self._fit.minimum if is_fresh else None

    def _keep_fit(self, message: Float32) -> None:
        self._fit.add(message.data)
        self._fit_at = rospy.Time.now()
