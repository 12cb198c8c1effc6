"""Teleoperation from the page: velocity commands while keys are held."""

import threading
import time
from typing import Optional

import rospy
from geometry_msgs.msg import Twist

from planar_ros.node.topics import flush_and_close
from teleop_lite.teleop import TICK_SECONDS, Teleop

# Zero velocities are published for this long after the robot has stopped [s].
RESTING_SECONDS = 0.5
# Wall time at shutdown for the stop command to be delivered [s].
FLUSH_SECONDS = 1.0
FORCE_STOP = "k"


class PageTeleop:
    """Publishes velocities while a page repeats a key; a closed or frozen page stops the robot."""

    def __init__(self):
        self._lock = threading.Lock()
        self._teleop = Teleop()
        self._publisher: Optional[rospy.Publisher] = None
        self._driver: Optional[int] = None
        self._busy_until = 0.0
        self._wake = threading.Event()
        threading.Thread(target=self._work, daemon=True).start()

    def press(self, key: str, client: int, topic: str) -> None:
        """Handle a key or button; called repeatedly while it is held.

        Args:
            key: Key of turtlebot_teleop.
            client: Client id of the page on which it is held.
            topic: Velocity topic.
        """
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
        """Stop the robot that a disconnected client has driven."""
        with self._lock:
            if client == self._driver:
                self._stop()

    def close(self) -> None:
        """Publish and flush a stop command before the node shuts down."""
        with self._lock:
            is_driving = self._driver is not None
            self._stop()
            if is_driving and self._publisher is not None:
                flush_and_close(self._publisher, patience=FLUSH_SECONDS)

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
