"""Localize the robot globally: start global localization, then rotate in place until it has converged.

spin_until_localized [--timeout SECONDS] [--turn-speed RAD_PER_S] [--node AMCL]
"""

import argparse
import math
import time
from typing import Optional

import numpy as np
import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped, Twist
from std_msgs.msg import String
from std_srvs.srv import Empty

from planar import PlanarError
from planar_ros.messages.conversion import pose2_from_msg
from planar_ros.messages.validation import subscribe
from planar_ros.node.runner import fail, run
from planar_ros.node.topics import publish_on_shutdown

# Standard deviations below which the particles have converged [m, m, rad].
SETTLED_WITHIN = np.array((0.2, 0.2, 0.1))
POLL_SECONDS = 0.05
# Longest wall time without the node, or with a stopped clock [s].
PATIENCE_SECONDS = 10.0


class NotLocalizedError(PlanarError):
    """The robot could not be localized."""


class SpinUntilLocalized:
    """Rotates until the particles have converged and amcl_lite reports that its scans fit the map.

    The official amcl does not publish the fit; then convergence of the particles is sufficient.
    """

    def __init__(self, node: str):
        self._state: Optional[str] = None
        self._pose: Optional[PoseWithCovarianceStamped] = None
        self._asked_at = rospy.Time(0)
        self._cmd_vel = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        publish_on_shutdown(self._cmd_vel, Twist())
        rospy.Subscriber(f"{node}/localization_state", String, self._on_state, queue_size=2)
        subscribe("amcl_pose", PoseWithCovarianceStamped, self._on_pose, queue_size=2)

    def spin(self, timeout: float, turn_speed: float) -> str:
        """Localize and return the pose as text. Raises NotLocalizedError after ``timeout`` [s, ROS time]."""
        _wait_for_time()
        self._ask_for_global_localization()
        clock = _Clock()
        while not self._is_localized():
            if clock.elapsed() > timeout:
                raise NotLocalizedError(f"not localized within {timeout:g} s: {self._why_not()}")
            turn = Twist()
            turn.angular.z = turn_speed
            self._cmd_vel.publish(turn)
            time.sleep(POLL_SECONDS)
        assert self._pose is not None
        pose = pose2_from_msg(self._pose.pose.pose)
        return f"localized at ({pose.x:.2f}, {pose.y:.2f}, {pose.yaw:.2f}) after {clock.elapsed():.1f} s"

    def _ask_for_global_localization(self):
        service = rospy.resolve_name("global_localization")
        try:
            rospy.wait_for_service(service, PATIENCE_SECONDS)
        except rospy.ROSException:
            raise NotLocalizedError(f"no service {service} within {PATIENCE_SECONDS:g} s") from None
        rospy.ServiceProxy(service, Empty)()
        self._asked_at = rospy.Time.now()

    def _is_localized(self):
        return self._has_settled() and self._state in (None, "ok")

    def _has_settled(self):
        return self._pose is not None and bool(np.all(_spreads(self._pose) < SETTLED_WITHIN))

    def _why_not(self):
        if self._pose is None:
            return f"no pose came on {rospy.resolve_name('amcl_pose')}"
        if self._has_settled():
            return "the scans do not fit the map at the only place left"
        return "standard deviations of {:.2f} m, {:.2f} m, {:.2f} rad are left".format(*_spreads(self._pose))

    def _on_state(self, message):
        self._state = message.data

    def _on_pose(self, message):
        if message.header.stamp > self._asked_at > rospy.Time(0):
            self._pose = message


class _Clock:
    """ROS time since the start; raises NotLocalizedError if the clock stops."""

    def __init__(self):
        self._start = self._newest = rospy.get_time()
        self._moved_at = time.monotonic()

    def elapsed(self) -> float:
        now = rospy.get_time()
        if now != self._newest:
            self._newest, self._moved_at = now, time.monotonic()
        if rospy.is_shutdown():
            raise NotLocalizedError("interrupted")
        if time.monotonic() - self._moved_at > PATIENCE_SECONDS:
            raise NotLocalizedError(
                f"/clock has not advanced for {PATIENCE_SECONDS:g} s; is the simulation paused?"
            )
        return now - self._start


def _wait_for_time():
    """Wait for /clock: without time, new poses cannot be distinguished from old ones."""
    until = time.monotonic() + PATIENCE_SECONDS
    while not rospy.get_time():
        if rospy.is_shutdown() or time.monotonic() > until:
            raise NotLocalizedError(f"no message on /clock within {PATIENCE_SECONDS:g} s")
        time.sleep(POLL_SECONDS)


def _spreads(message) -> np.ndarray:
    """Standard deviations (3,) of x, y and yaw."""
    return np.sqrt(np.maximum(np.reshape(message.pose.covariance, (6, 6)).diagonal()[[0, 1, 5]], 0.0))


def main():
    arguments = _parser().parse_args(rospy.myargv()[1:])

    def start():
        try:
            sentence = SpinUntilLocalized(arguments.node).spin(arguments.timeout, arguments.turn_speed)
        except NotLocalizedError as error:
            fail(str(error), exit_code=1)
        rospy.loginfo("%s", sentence)
        rospy.signal_shutdown(sentence)

    run("spin_until_localized", start)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="spin_until_localized",
        description="Localizes the robot anywhere in the map: distributes amcl's particles over the free "
        "space, then rotates the robot in place until it is localized. Exit code 0: localized; 1: not "
        "localized, with the reason.",
    )
    parser.add_argument(
        "--timeout", type=_positive, default=60.0, metavar="SECONDS", help="ROS time (%(default)s)"
    )
    parser.add_argument(
        "--turn-speed", type=_positive, default=0.6, metavar="RAD_PER_S", help="to the left (%(default)s)"
    )
    parser.add_argument("--node", default="amcl", help="name of the localization node (%(default)s)")
    return parser


def _positive(text: str) -> float:
    value = float(text)
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError(f"{text} is not a positive number")
    return value
