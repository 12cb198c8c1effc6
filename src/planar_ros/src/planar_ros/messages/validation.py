"""Validation of received messages: values are finite, in range and of the right length.

The conversions of this package raise a PlanarError for invalid messages, so that the algorithms receive valid
numbers only. ``subscribe`` and ``advertise_service`` report rejected messages and requests.
"""

from typing import Any, Callable, Type

import genpy
import rospy

from planar import PlanarError
from planar.geometry.limits import MAX_SPEED, is_within

# Shortest time between identical warnings [s].
WARN_SECONDS = 5.0

# Latest valid stamp [s]: tf2 ends the process if the difference of two stamps overflows.
LATEST_STAMP = 2**31 - 1000


class MessageError(PlanarError):
    """A message is invalid; the text names the field and its value."""


def subscribe(
    topic: str, kind: Type[genpy.Message], handle: Callable[[Any], object], **how: Any
) -> rospy.Subscriber:
    """Subscribe to a topic; messages that the handler rejects are logged and ignored.

    Args:
        topic: Topic name.
        kind: Message type.
        handle: Handler; raises a PlanarError for an invalid message.
        how: Further arguments of rospy.Subscriber.

    Returns:
        The subscriber.
    """

    def on_message(message):
        try:
            handle(message)
        except PlanarError as error:
            name = rospy.resolve_name(topic)
            rospy.logwarn_throttle_identical(WARN_SECONDS, f"{name}: ignored: {error}")

    return rospy.Subscriber(topic, kind, on_message, **how)


def advertise_service(name: str, kind: Any, handle: Callable[[Any], object]) -> rospy.Service:
    """Advertise a service; a request that the handler rejects fails with the text of its error.

    Args:
        name: Service name.
        kind: Service type.
        handle: Handler; returns the response or raises a PlanarError.

    Returns:
        The service.
    """

    def answer(request):
        try:
            return handle(request)
        except PlanarError as error:
            raise rospy.ServiceException(str(error)) from None

    return rospy.Service(name, kind, answer)


def is_stamp(stamp: genpy.Time) -> bool:
    """Whether tf2 accepts a stamp."""
    return 0 <= stamp.secs < LATEST_STAMP


def check_twist(twist) -> None:
    """Check a geometry_msgs/Twist.

    Raises:
        MessageError: If a velocity is not finite or exceeds MAX_SPEED.
    """
    linear, angular = twist.linear, twist.angular
    if not is_within(MAX_SPEED, linear.x, linear.y, linear.z, angular.x, angular.y, angular.z):
        raise MessageError(f"invalid velocity: not finite, or above {MAX_SPEED:g} m/s or rad/s")
