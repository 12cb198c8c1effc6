"""Where a robot's topics and frames are."""

from typing import List

import rospy

from sim_bridge.ros.performance import CountingPublisher


class Outlet:
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
