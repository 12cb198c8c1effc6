"""Hearing what the simulation says."""

from typing import Any, List
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
from waiting import wait_until


class Heard:
    """The messages of a topic since then."""

    def __init__(self, topic, kind):
        self.messages: List[Any] = []
        self._subscriber = rospy.Subscriber(topic, kind, self.messages.append, queue_size=1000)

    def next(self):
        return self.following(1)[0]

    def following(self, count):
        """The next ``count`` messages."""
        first = len(self.messages)
        wait_until("messages", lambda: len(self.messages) >= first + count)
        return self.messages[first : first + count]

    def is_connected(self):
        return hears_all(self._subscriber)

    def close(self):
        self._subscriber.unregister()


def hears_all(subscriber):
    """Whether there are publishers, and all send to it: what they publish only once is not missed."""
    published = dict(rosgraph.Master(rospy.get_name()).getSystemState()[0])
    publishers = published.get(subscriber.resolved_name, [])
    return 0 < len(publishers) <= sum(map(_is_sent_to, list(subscriber.impl.connections)))


def _is_sent_to(connection):
    """A publisher begins to send on a connection some milliseconds after its subscriber has counted it."""
    publisher: Any = ServerProxy(connection.endpoint_id)
    _, _, connections = publisher.getBusInfo(rospy.get_name())
    port = f":{connection.local_endpoint[1]} "
    return any(direction == "o" and port in about for _, _, direction, _, _, _, about in connections)
