"""Says what a node waits for."""

import threading
import time
from typing import Callable, ClassVar, Dict, List, Mapping, Optional

import rosgraph
import rospy
from std_msgs.msg import String

from planar_ros.lockstep import LockstepClient

# Private topic, latched: what the node waits for, one a line; empty once it has everything.
WAITING_FOR_TOPIC = "waiting_for"
PATIENCE_SECONDS = 4.0
POLL_SECONDS, HELD_UP_SECONDS = 0.2, 1.0


class _WaitingForPublisher:
    """Of what a node waits for, a part: all of them tell together, on one topic."""

    _lacking: ClassVar[Dict["_WaitingForPublisher", List[str]]] = {}
    _told: ClassVar[Optional[str]] = None
    _lock: ClassVar[threading.Lock] = threading.Lock()

    def __init__(self) -> None:
        self._publisher = rospy.Publisher(f"~{WAITING_FOR_TOPIC}", String, queue_size=1, latch=True)

    def tell(self, lacking: List[str]) -> None:
        """What this part lacks now."""
        with self._lock:
            self._lacking[self] = lacking
            text = "\n".join(name for part in self._lacking.values() for name in part)
            if text != _WaitingForPublisher._told:
                _WaitingForPublisher._told = text
                self._publisher.publish(text)


class ReadinessMonitor:
    """Watches the conditions a node needs before it can work, and names once each that stays unmet.

    On ``~waiting_for`` it tells at any time which they are.

    ``conditions`` maps what is waited for ("a scan on /scan") to a function that says whether it is there.
    Counted in wall time, since simulated time may be what is missing.
    """

    def __init__(self, conditions: Mapping[str, Callable[[], bool]]):
        self._conditions = conditions
        self._missing: Optional[List[str]] = None
        self._teller = _WaitingForPublisher()
        self._step = LockstepClient.existing()
        if self._step is not None:
            self._step.on_instant(self._look)
        threading.Thread(target=self._watch, daemon=True).start()

    def _watch(self):
        start, told = time.monotonic(), False
        while not rospy.is_shutdown():
            if self._step is None or not self._step.is_synchronized:
                self._look()
            if not self._missing:
                if told:
                    rospy.loginfo("nothing to wait for any more")
                return
            if not told and time.monotonic() - start > PATIENCE_SECONDS:
                told = True
                for name in self._missing:
                    rospy.logwarn("waiting for %s", name)
                _check_clock()
            time.sleep(POLL_SECONDS)

    def _look(self):
        if self._missing != []:
            missing = [name for name, is_met in self._conditions.items() if not is_met()]
            if missing != self._missing:
                self._missing = missing
                self._teller.tell(missing)


class StallReporter:
    """Tells on ``~waiting_for`` whom a node that works already waits for, if it does so for a while."""

    def __init__(self, patience: float = HELD_UP_SECONDS):
        self._patience = patience
        self._since: Optional[float] = None
        self._told: List[str] = []
        self._teller = _WaitingForPublisher()

    def update(self, names: List[str]) -> None:
        """Those that are waited for now; to be called again and again."""
        now = time.monotonic()
        if not names:
            self._since = None
        elif self._since is None:
            self._since = now
        is_long = self._since is not None and now - self._since > self._patience
        to_tell = names if is_long else []
        if to_tell != self._told:
            self._told = to_tell
            self._teller.tell(to_tell)


class NodeReadiness:
    """Whether another node has all that it waits for, by what it tells on its ``~waiting_for``."""

    def __init__(self, node: str):
        self._is_ready = False
        rospy.Subscriber(f"{node}/{WAITING_FOR_TOPIC}", String, self._hear, queue_size=10)

    def __call__(self) -> bool:
        return self._is_ready

    def _hear(self, message):
        self._is_ready = not message.data


def _check_clock():
    if not rospy.get_param("/use_sim_time", False):
        return
    published = {topic for topic, _ in rosgraph.Master(rospy.get_name()).getPublishedTopics("")}
    if "/clock" not in published:
        rospy.logwarn("use_sim_time is true, but nobody publishes /clock")
