"""Orders become goals and plans of move_base, what comes of them becomes events."""

from typing import Optional, Union

import rospy

from pick_objects.approach import GoTo
from pick_objects.errand import MeasureWays, WaysMeasured
from planar import Pose2
from planar.driving import GoalReached, GoalRefused
from planar_ros.calls.move_base import MoveBase
from planar_ros.calls.services import ServiceError


class Driver:
    """Has move_base drive, one order at a time."""

    def __init__(self, frame_id: str):
        self.move_base = MoveBase(frame_id)
        self._order: Optional[GoTo] = None

    @property
    def robot_in_map(self) -> Pose2:
        return self.move_base.robot or Pose2()

    def send(self, order: GoTo) -> None:
        if order.attempt > 1:
            place, pose = order.place.name, order.pose
            rospy.logwarn("place %s: attempt %d, at (%g, %g)", place, order.attempt, pose.x, pose.y)
        self._order = order
        self.move_base.send(order.pose)

    def event(self) -> Union[None, GoalReached, GoalRefused]:
        """What came of the last goal, told once; None while it is pursued."""
        outcome = self.move_base.outcome()
        if outcome is None or self._order is None:
            return None
        event = outcome.event
        if isinstance(event, GoalRefused):
            rospy.logwarn("place %s: %s", self._order.place.name, event.reason)
        return event

    def measure(self, order: MeasureWays) -> WaysMeasured:
        """The lengths of move_base's plans; straight lines if it makes no plans."""
        try:
            return WaysMeasured(tuple(self.move_base.plan_length(start, end) for start, end in order.ways))
        except ServiceError as error:
            rospy.logwarn("the order of the deliveries goes by straight lines: %s", error)
            lines = ((start or self.robot_in_map).distance_to(end) for start, end in order.ways)
            return WaysMeasured(tuple(lines))
