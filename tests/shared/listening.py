"""Hearing what the simulation says."""

from typing import Any, List

import rospy
from waiting import wait_until

from supervision.ros import node_api


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
    """Whether there are publishers, and all send to it: what they publish only once is not missed.

    A publisher begins to send some milliseconds after rospy's subscriber has counted the connection.
    """
    is_connected = subscriber.get_num_connections() > 0
    return is_connected and node_api.hears_all(rospy.get_name(), [subscriber.resolved_name])
