"""ROS interface of home_service."""

from typing import Any, Callable

import rospy


def subscribe(topic: str, kind: type, callback: Callable[[Any], None]) -> None:
    """Subscribe without losing messages, however long the callback is delayed.

    rospy keeps one queue for each topic and process, with the length requested last: a short one would also
    cut the queue of the other subscribers in this process.

    Args:
        topic: Topic, relative to the namespace.
        kind: Message class.
        callback: Called with each message.
    """
    rospy.Subscriber(topic, kind, callback, queue_size=None, tcp_nodelay=True)
