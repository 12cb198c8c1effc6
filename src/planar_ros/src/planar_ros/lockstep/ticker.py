"""Work that is due again and again in ROS time, in step or not."""

import threading
import time
from typing import Callable

import rospy
from std_msgs.msg import Header

from planar_ros.node.clock import sleep_until

NEVER = rospy.Time(0)
# Wall seconds between two looks whether the node is still in step.
IN_STEP_SECONDS = 0.2


class Ticker:
    """Calls ``tick(now)`` every ``period()`` seconds, ``on_time_jump()`` when ROS time has jumped back."""

    def __init__(
        self,
        period: Callable[[], float],
        tick: Callable[[rospy.Time], None],
        on_time_jump: Callable[[], None],
    ):
        self._period, self._tick, self._on_time_jump = period, tick, on_time_jump
        self._due = NEVER
        self._looked_at = NEVER
        self._lock = threading.RLock()

    def start(self, is_in_step: Callable[[], bool], report: Callable[[rospy.Time], None]) -> None:
        """Works in a thread of its own whenever the node is not in step, and reports each time."""
        threading.Thread(target=self._work, args=(is_in_step, report), daemon=True).start()

    def poll(self) -> None:
        """Works if it is due now."""
        with self._lock:
            now, period = rospy.Time.now(), rospy.Duration(self._period())
            if now < self._looked_at:
                self._restart()
            self._looked_at = now
            self._due = min(self._due, now + period)  # the period may have become shorter
            if now != rospy.Time(0) and now >= self._due:
                self._due = max(self._due + period, now) if self._due != NEVER else now + period
                self._tick(now)

    def _work(self, is_in_step, report) -> None:
        while not rospy.is_shutdown():
            with self._lock:
                due, looked_at = self._due, self._looked_at
            try:
                now = sleep_until(due, looked_at)
            except rospy.ROSTimeMovedBackwardsException:
                now = None
            with self._lock:
                if not is_in_step():  # if it is, a moment looks
                    if now is None:
                        self._restart()
                    else:
                        self.poll()
                        report(now)
                    continue
            time.sleep(IN_STEP_SECONDS)

    def _restart(self) -> None:
        self._due = self._looked_at = NEVER
        self._on_time_jump()


PROGRESS_TOPIC = "/simulation/progress"


class ProgressPublisher:
    """Reports the simulated time up to which this node has worked; silent without simulated time."""

    def __init__(self):
        self._publisher = None
        if rospy.get_param("/use_sim_time", False):
            self._publisher = rospy.Publisher(PROGRESS_TOPIC, Header, queue_size=10, tcp_nodelay=True)

    def report(self, stamp: rospy.Time) -> None:
        if self._publisher is not None:
            self._publisher.publish(Header(stamp=stamp, frame_id=rospy.get_name().lstrip("/")))
