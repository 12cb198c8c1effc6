"""Periodic work in ROS time, in lock-step or not, and progress reports to the simulator."""

import threading
import time
from typing import Callable

import rospy
from std_msgs.msg import Header

from planar_ros.node.clock import sleep_until

NEVER = rospy.Time(0)
# Interval at which a synchronized node's thread checks whether it still is [wall s].
CHECK_SECONDS = 0.2


class Ticker:
    """Calls ``tick(now)`` every ``period()`` seconds and ``on_time_jump()`` when ROS time has jumped back."""

    def __init__(
        self,
        period: Callable[[], float],
        tick: Callable[[rospy.Time], None],
        on_time_jump: Callable[[], None],
    ):
        self._period, self._tick, self._on_time_jump = period, tick, on_time_jump
        self._due = NEVER
        self._polled_at = NEVER
        self._lock = threading.RLock()

    def start(self, is_synchronized: Callable[[], bool], report: Callable[[rospy.Time], None]) -> None:
        """Start a thread that ticks while the node is not synchronized, and calls ``report`` each time."""
        threading.Thread(target=self._work, args=(is_synchronized, report), daemon=True).start()

    def poll(self) -> None:
        """Tick if it is due."""
        with self._lock:
            now, period = rospy.Time.now(), rospy.Duration(self._period())
            if now < self._polled_at:
                self._restart()
            self._polled_at = now
            self._due = min(self._due, now + period)  # the period may have been shortened
            if now != rospy.Time(0) and now >= self._due:
                self._due = max(self._due + period, now) if self._due != NEVER else now + period
                self._tick(now)

    def _work(self, is_synchronized, report) -> None:
        while not rospy.is_shutdown():
            with self._lock:
                due, polled_at = self._due, self._polled_at
            try:
                now = sleep_until(due, polled_at)
            except rospy.ROSTimeMovedBackwardsException:
                now = None
            with self._lock:
                if not is_synchronized():  # otherwise the instant polls
                    if now is None:
                        self._restart()
                    else:
                        self.poll()
                        report(now)
                    continue
            time.sleep(CHECK_SECONDS)

    def _restart(self) -> None:
        self._due = self._polled_at = NEVER
        self._on_time_jump()


PROGRESS_TOPIC = "/simulation/progress"


class ProgressPublisher:
    """Publishes the simulated time up to which this node has worked; does nothing without simulated time."""

    def __init__(self):
        self._publisher = None
        if rospy.get_param("/use_sim_time", False):
            self._publisher = rospy.Publisher(PROGRESS_TOPIC, Header, queue_size=10, tcp_nodelay=True)

    def report(self, stamp: rospy.Time) -> None:
        """Publish that the node has worked up to ``stamp``."""
        if self._publisher is not None:
            self._publisher.publish(Header(stamp=stamp, frame_id=rospy.get_name().lstrip("/")))
