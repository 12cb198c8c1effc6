"""Hearing what the simulation says."""

from typing import Any, List

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
        return self._subscriber.get_num_connections() > 0
