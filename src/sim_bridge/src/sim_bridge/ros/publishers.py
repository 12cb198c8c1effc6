"""Where a robot's topics and frames are."""

from typing import List

import rospy
from rospy.impl.tcpros_pubsub import QueuedConnection


class CountingPublisher(rospy.Publisher):
    """Counts its messages, and those that are lost because a subscriber is too slow for its queue."""

    def __init__(self, *arguments, **named):
        super().__init__(*arguments, **named)
        self.published = self.dropped = 0

    def publish(self, *arguments, **named):
        self.published += 1
        self.dropped += sum(_is_full(connection) for connection in self.impl.connections)
        super().publish(*arguments, **named)


class RobotPublishers:
    """Opens topics below ``namespace``; before the names of frames comes ``tf_prefix``."""

    def __init__(self, namespace: str, tf_prefix: str):
        self._namespace = namespace
        self._tf_prefix = f"{tf_prefix}/" if tf_prefix else ""
        self.publishers: List[CountingPublisher] = []

    def publisher(
        self, topic: str, kind: type, queue_size: int = 10, latch: bool = False
    ) -> CountingPublisher:
        name = rospy.names.ns_join(self._namespace, topic)
        publisher = CountingPublisher(name, kind, queue_size=queue_size, latch=latch, tcp_nodelay=True)
        self.publishers.append(publisher)
        return publisher

    def frame(self, name: str) -> str:
        return self._tf_prefix + name.lstrip("/")

    def close(self) -> None:
        """Ends the topics."""
        for publisher in self.publishers:
            publisher.unregister()


def _is_full(connection) -> bool:
    """Whether the oldest message of a connection's queue is about to be thrown away."""
    if not isinstance(connection, QueuedConnection):
        return False
    return 0 < connection._queue_size <= len(connection._queue)
