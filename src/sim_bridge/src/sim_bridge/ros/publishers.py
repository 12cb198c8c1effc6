"""Publishers of a robot's topics."""

from typing import List

import rospy
from rosgraph.names import ns_join

from rospy_transport.connections import full_queues


class CountingPublisher(rospy.Publisher):
    """Counts published messages, and those that are dropped because a subscriber's queue is full."""

    def __init__(self, *arguments, **named):
        super().__init__(*arguments, **named)
        self.published = self.dropped = 0

    def publish(self, *arguments, **named):
        self.published += 1
        self.dropped += full_queues(self)
        super().publish(*arguments, **named)


class RobotPublishers:
    """Creates publishers below a namespace, and frame names with a prefix.

    Args:
        namespace: Namespace of the topics.
        tf_prefix: Prefix of the frames, without slash; empty for none.
    """

    def __init__(self, namespace: str, tf_prefix: str):
        self._namespace = namespace
        self._tf_prefix = f"{tf_prefix}/" if tf_prefix else ""
        self.publishers: List[CountingPublisher] = []

    def publisher(
        self, topic: str, kind: type, queue_size: int = 10, latch: bool = False
    ) -> CountingPublisher:
        """Advertise a topic.

        Args:
            topic: Name of the topic, relative to the namespace.
            kind: Type of its messages.
            queue_size: Number of messages that wait for a slow subscriber.
            latch: Whether new subscribers receive the last message.
        """
        name = ns_join(self._namespace, topic)
        publisher = CountingPublisher(name, kind, queue_size=queue_size, latch=latch, tcp_nodelay=True)
        self.publishers.append(publisher)
        return publisher

    def frame(self, name: str) -> str:
        """Return the name of a frame with the prefix."""
        return self._tf_prefix + name.lstrip("/")

    def close(self) -> None:
        """Unregister all publishers."""
        for publisher in self.publishers:
            publisher.unregister()
