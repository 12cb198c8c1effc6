"""Work of a node over time: periodic callbacks, threads that take turns, progress reports."""

import threading
import time
from typing import Callable, Set

import rospy
from std_msgs.msg import Header

from rospy_transport.node import sleep_until

NEVER = rospy.Time(0)
# Longest time between two polls, besides two periods, that is no jump of the clock [s].
LONGEST_GAP = 1.0
# Interval at which a synchronized node's thread checks whether it still is [wall s].
CHECK_SECONDS = 0.2


class Ticker:
    """Calls ``tick(now)`` every ``period()`` seconds and ``on_time_jump()`` when ROS time has jumped back.

    When it has jumped ahead, the first poll does not tick: what the other nodes make of the new time, such as
    transforms, arrives with the next one.
    """

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
            last, self._polled_at = self._polled_at, now
            if last != NEVER and (now - last).to_sec() > max(LONGEST_GAP, 2.0 * period.to_sec()):
                return
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


class LockstepThreads:
    """Lets registered threads run for one turn at each logical instant, and waits until all wait again."""

    def __init__(self):
        self._changed = threading.Condition()
        self._members: Set[int] = set()
        self._running: Set[int] = set()

    def register(self) -> None:
        """Register the calling thread; its first turn starts at once."""
        with self._changed:
            self._members.add(threading.get_ident())
            self._running.add(threading.get_ident())

    def unregister(self) -> None:
        """Unregister the calling thread."""
        with self._changed:
            self._members.discard(threading.get_ident())
            self._end_turn()

    def is_registered(self) -> bool:
        """Return whether the calling thread is registered."""
        return threading.get_ident() in self._members

    def wait_for_turn(self, is_off: Callable[[], bool]) -> None:
        """End the turn of the calling thread; return at its next turn or when ``is_off``."""
        with self._changed:
            self._end_turn()
            while threading.get_ident() not in self._running and not is_off():
                self._changed.wait(0.2)

    def run_turn(self, is_off: Callable[[], bool]) -> None:
        """Give every thread a turn; return when all have ended theirs or ``is_off``."""
        with self._changed:
            self._running = set(self._members)
            self._changed.notify_all()
        self.wait_until_idle(is_off)

    def wait_until_idle(self, is_off: Callable[[], bool]) -> None:
        """Wait until no thread has a turn or ``is_off``."""
        with self._changed:
            while self._running and not is_off():
                self._changed.wait(0.2)

    def notify(self) -> None:
        """Wake the waiting threads to check their conditions."""
        with self._changed:
            self._changed.notify_all()

    def _end_turn(self) -> None:
        self._running.discard(threading.get_ident())
        self._changed.notify_all()


PROGRESS_TOPIC, IDLE_TOPIC = "/simulation/progress", "/simulation/idle"


class ProgressPublisher:
    """Publishes a simulated time of this node; does nothing without simulated time.

    Args:
        topic: PROGRESS_TOPIC: up to when the node has worked; IDLE_TOPIC: until when it has nothing to do.
    """

    def __init__(self, topic: str = PROGRESS_TOPIC):
        self._publisher = None
        if rospy.get_param("/use_sim_time", False):
            self._publisher = rospy.Publisher(topic, Header, queue_size=10, tcp_nodelay=True)

    def report(self, stamp: rospy.Time) -> None:
        """Publish the time."""
        if self._publisher is not None:
            self._publisher.publish(Header(stamp=stamp, frame_id=rospy.get_name().lstrip("/")))
