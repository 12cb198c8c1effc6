"""Detect that simulated time has stopped, and report why."""

import threading
import time
from typing import Callable, List, Optional, Sequence

import rospy
from gazebo_msgs.srv import GetPhysicsProperties, GetPhysicsPropertiesRequest
from rosgraph_msgs.msg import Clock
from std_msgs.msg import String

from planar_ros.calls.services import ServiceError, call_service
from planar_ros.node.readiness import WAITING_FOR_TOPIC as WAITING_TOPIC

SIMULATOR = "/sim_bridge"
# Wall-clock time after which a stopped clock is reported, and time-out of the simulator's answer [s].
STANDING_SECONDS, ANSWER_SECONDS = 3.0, 3.0


class ClockMonitor:
    """Detects that ``/clock`` has stopped and asks the simulator why.

    Args:
        log: Called with the reason when the clock has stopped.
        patience: Wall-clock time without progress after which the clock counts as stopped [s].

    Attributes:
        reason: Why simulated time stands still, in words; None while it advances.
    """

    def __init__(self, log: Callable[[str], None], patience: float = STANDING_SECONDS):
        self.reason: Optional[str] = None
        self._log, self._patience = log, patience
        self._stamp: Optional[float] = None
        self._since = 0.0
        self._is_querying = False
        self._waiting_for: List[str] = []

    def start(self) -> None:
        """Subscribe; this process is a node by then."""
        rospy.Subscriber("/clock", Clock, lambda message: self.on_clock(message.clock.to_sec()), queue_size=1)
        rospy.Subscriber(
            f"{SIMULATOR}/{WAITING_TOPIC}", String, lambda message: self.on_waiting(message.data)
        )

    def on_waiting(self, names: str) -> None:
        """Store the nodes that the simulator waits for, one a line."""
        self._waiting_for = names.splitlines()

    def on_clock(self, stamp: float) -> None:
        """Store the current time [s]."""
        if stamp != self._stamp:
            self._stamp, self._since, self.reason = stamp, time.monotonic(), None

    def check(self) -> None:
        """Check the clock; to be called periodically."""
        stands = self._stamp is not None and time.monotonic() - self._since > self._patience
        if stands and self.reason is None and not self._is_querying:
            self._is_querying = True
            threading.Thread(target=self._query, args=(self._stamp,), daemon=True).start()

    def _query(self, stamp: float) -> None:
        why = why_clock_stopped(self._waiting_for)
        if stamp == self._stamp:
            self.reason = f"simulated time stands still at {stamp:.1f} s: {why}"
            self._log(self.reason)
        self._is_querying = False


def why_clock_stopped(waiting_for: Sequence[str]) -> str:
    """Ask the simulator why time stands still; ``waiting_for``: nodes that it has published to wait for."""
    request, name = GetPhysicsPropertiesRequest(), "/gazebo/get_physics_properties"
    try:
        is_paused = call_service(name, GetPhysicsProperties, request, ANSWER_SECONDS).pause
    except ServiceError as error:
        return f"the simulator does not answer ({error})"
    if is_paused:
        return "the simulation is paused"
    return f"the simulator waits for {', '.join(waiting_for) or 'nodes (see doctor.sh)'}"
