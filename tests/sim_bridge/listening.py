"""Waiting for the simulation, and hearing what it says."""

import time

import rospy

PATIENCE_SECONDS = 20.0


def wait_until(what, is_met):
    deadline = time.monotonic() + PATIENCE_SECONDS
    while not is_met():
        assert time.monotonic() < deadline, f"waited in vain for {what}"
        time.sleep(0.005)


class Heard:
    """The messages of a topic since then."""

    def __init__(self, topic, kind):
        self.messages = []
        self._subscriber = rospy.Subscriber(topic, kind, self.messages.append, queue_size=1000)

    def next(self):
        count = len(self.messages)
        wait_until("a message", lambda: len(self.messages) > count)
        return self.messages[-1]

    def is_connected(self):
        return self._subscriber.get_num_connections() > 0
