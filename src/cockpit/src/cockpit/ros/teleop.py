"""Driving by hand from the page: velocities follow the keys that are held, and cease with them."""

import threading
import time
from typing import Optional

import rospy
from geometry_msgs.msg import Twist

from planar_ros.node.last_words import flush_and_close
from teleop_lite.teleop import TICK_SECONDS, Teleop

# So long after it has come to rest the robot is told so, then others may drive it.
RESTING_SECONDS = 0.5
# Wall seconds at the end for the robot to hear that it is to stop.
LAST_WORD_SECONDS = 1.0
FORCE_STOP = "k"


class PageTeleop:
    """A page that is closed, frozen or cut off sends no more keys, and that is what letting go is."""

    def __init__(self):
        self._lock = threading.Lock()
        self._teleop = Teleop()
        self._publisher: Optional[rospy.Publisher] = None
        self._driver: Optional[int] = None
        self._busy_until = 0.0
        self._wake = threading.Event()
        threading.Thread(target=self._work, daemon=True).start()

    def press(self, key: str, client: int, topic: str) -> None:
        """A key or button of the page ``client`` is held: to be called again and again while it is."""
        with self._lock:
            if self._publisher is None or self._publisher.resolved_name != rospy.resolve_name(topic):
                self._stop()
                if self._publisher is not None:
                    self._publisher.unregister()
                self._publisher = rospy.Publisher(topic, Twist, queue_size=5, tcp_nodelay=True)
            self._driver = client
            self._teleop.press(key)
            self._busy_until = time.monotonic() + RESTING_SECONDS
        self._wake.set()

    def release(self, client: int) -> None:
        """The page is gone: the robot that it drove stops at once."""
        with self._lock:
            if client == self._driver:
                self._stop()

    def close(self) -> None:
        """For good, before the node ends: the robot hears that it is to stop."""
        with self._lock:
            is_driving = self._driver is not None
            self._stop()
            if is_driving and self._publisher is not None:
                flush_and_close(self._publisher, patience=LAST_WORD_SECONDS)

    def _stop(self) -> None:
        self._teleop.press(FORCE_STOP)
        if self._publisher is not None and self._driver is not None:
            self._publisher.publish(Twist())
        self._driver = None

    def _work(self) -> None:
        while not rospy.is_shutdown():
            self._wake.wait()
            with self._lock:
                now = time.monotonic()
                velocity = self._teleop.tick(now)
                if velocity.v or velocity.omega:
                    self._busy_until = now + RESTING_SECONDS
                if self._publisher is not None:
                    self._publisher.publish(_twist(velocity))
                if now > self._busy_until:
                    self._wake.clear()
                    self._driver = None
            time.sleep(TICK_SECONDS)


def _twist(velocity) -> Twist:
    message = Twist()
    message.linear.x, message.angular.z = velocity.v, velocity.omega
    return message
