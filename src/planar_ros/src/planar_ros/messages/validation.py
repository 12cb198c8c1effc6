"""The border: what comes by topic is finite, in range and of the right length, or it does not come in.

The conversions of this room raise a PlanarError for what means nothing, so that the cores behind may count on
their numbers; ``listen`` and ``serve`` tell of what was refused.
"""

from typing import Any, Callable, Type

import genpy
import rospy

from planar import PlanarError
from planar.geometry.limits import MAX_SPEED, is_within

WARN_SECONDS = 5.0


# Seconds: tf2 ends the process for stamps whose differences it cannot hold.
LATEST_STAMP = 2**31 - 1000


class MessageError(PlanarError):
    """A message means nothing; the text says what is wrong with it."""


def subscribe(
    topic: str, kind: Type[genpy.Message], handle: Callable[[Any], object], **how: Any
) -> rospy.Subscriber:
    """A subscriber that ignores a message for which ``handle`` raises a PlanarError, and says so."""

    def take(message):
        try:
            handle(message)
        except PlanarError as error:
            name = rospy.resolve_name(topic)
            rospy.logwarn_throttle_identical(WARN_SECONDS, f"{name}: ignored: {error}")

    return rospy.Subscriber(topic, kind, take, **how)


def advertise_service(name: str, kind: Any, handle: Callable[[Any], object]) -> rospy.Service:
    """A service; a request for which ``handle`` raises a PlanarError fails with its text."""

    def answer(request):
        try:
            return handle(request)
        except PlanarError as error:
            raise rospy.ServiceException(str(error)) from None

    return rospy.Service(name, kind, answer)


def is_stamp(stamp: genpy.Time) -> bool:
    """Whether tf2 can work with a stamp."""
    return 0 <= stamp.secs < LATEST_STAMP


def check_twist(twist) -> None:
    """Raises MessageError for a geometry_msgs/Twist that no robot has."""
    linear, angular = twist.linear, twist.angular
    if not is_within(MAX_SPEED, linear.x, linear.y, linear.z, angular.x, angular.y, angular.z):
        raise MessageError("a velocity that is not finite, or that no robot has, means nothing")
