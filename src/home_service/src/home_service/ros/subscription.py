"""How a run's judges and recorders hear the graph: every message, however much they are held up."""

from typing import Any, Callable

import rospy


def subscribe(topic: str, kind: type, callback: Callable[[Any], None]) -> None:
    """Subscribes, and loses nothing.

    rospy keeps one queue a topic and process, as long as its latest subscriber wants it: who asks for a short
    one cuts short what the others hear.
    """
    rospy.Subscriber(topic, kind, callback, queue_size=None, tcp_nodelay=True)
