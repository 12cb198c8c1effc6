"""Readiness: what a node waits for, in its log and on its topic ``~waiting_for``."""

import threading
import time
from typing import Callable, ClassVar, Dict, List, Mapping, Optional

import rosgraph
import rospy
from std_msgs.msg import String

from planar_ros.lockstep import LockstepClient

# Private latched topic: missing inputs, one a line; empty when the node is ready.
WAITING_FOR_TOPIC = "waiting_for"
PATIENCE_SECONDS = 4.0
POLL_SECONDS, STALL_SECONDS = 0.2, 1.0


class _WaitingForPublisher:
    """Publishes the missing inputs of one component together with those of the node's other components."""

    _missing_by_part: ClassVar[Dict["_WaitingForPublisher", List[str]]] = {}
    _published: ClassVar[Optional[str]] = None
    _lock: ClassVar[threading.Lock] = threading.Lock()

    def __init__(self) -> None:
        self._publisher = rospy.Publisher(f"~{WAITING_FOR_TOPIC}", String, queue_size=1, latch=True)

    def publish(self, missing: List[str]) -> None:
        """Set the missing inputs of this component."""
        with self._lock:
            self._missing_by_part[self] = missing
            text = "\n".join(name for part in self._missing_by_part.values() for name in part)
            if text != _WaitingForPublisher._published:
                _WaitingForPublisher._published = text
                self._publisher.publish(text)


class ReadinessMonitor:
    """Checks the inputs of a node until all are present, and logs and publishes the missing ones.

    Uses wall time, since simulated time may be what is missing.
    """

    def __init__(self, conditions: Mapping[str, Callable[[], bool]]):
        """Start checking.

        Args:
            conditions: Description of each input, e.g. ``a scan on /scan``, with a function that returns
                whether it is present.
        """
        self._conditions = conditions
        self._missing: Optional[List[str]] = None
        self._waiting_for = _WaitingForPublisher()
        self._lockstep = LockstepClient.existing()
        if self._lockstep is not None:
            self._lockstep.on_instant(self._check)
        threading.Thread(target=self._watch, daemon=True).start()

    def _watch(self):
        start, has_warned = time.monotonic(), False
        while not rospy.is_shutdown():
            if self._lockstep is None or not self._lockstep.is_synchronized:
                self._check()
            if not self._missing:
                if has_warned:
                    rospy.loginfo("all inputs are present")
                return
            if not has_warned and time.monotonic() - start > PATIENCE_SECONDS:
                has_warned = True
                for name in self._missing:
                    rospy.logwarn("waiting for %s", name)
                _check_clock()
            time.sleep(POLL_SECONDS)

    def _check(self):
        if self._missing != []:
            missing = [name for name, is_met in self._conditions.items() if not is_met()]
            if missing != self._missing:
                self._missing = missing
                self._waiting_for.publish(missing)


class StallReporter:
    """Publishes on ``~waiting_for`` which nodes a running node waits for, if it waits for long."""

    def __init__(self, patience: float = STALL_SECONDS):
        """Report waits longer than ``patience`` [wall s]."""
        self._patience = patience
        self._since: Optional[float] = None
        self._published: List[str] = []
        self._waiting_for = _WaitingForPublisher()

    def update(self, names: List[str]) -> None:
        """Set the nodes that are waited for; call it periodically."""
        now = time.monotonic()
        if not names:
            self._since = None
        elif self._since is None:
            self._since = now
        is_long = self._since is not None and now - self._since > self._patience
        reported = names if is_long else []
        if reported != self._published:
            self._published = reported
            self._waiting_for.publish(reported)


class NodeReadiness:
    """Whether another node is ready, from its topic ``~waiting_for``."""

    def __init__(self, node: str):
        self._is_ready = False
        rospy.Subscriber(f"{node}/{WAITING_FOR_TOPIC}", String, self._on_waiting_for, queue_size=10)

    def __call__(self) -> bool:
        return self._is_ready

    def _on_waiting_for(self, message):
        self._is_ready = not message.data


def _check_clock():
    if not rospy.get_param("/use_sim_time", False):
        return
    published = {topic for topic, _ in rosgraph.Master(rospy.get_name()).getPublishedTopics("")}
    if "/clock" not in published:
        rospy.logwarn("/use_sim_time is true, but no node publishes /clock: is the simulator running?")
