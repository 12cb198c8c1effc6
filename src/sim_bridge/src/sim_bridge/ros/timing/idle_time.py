"""Idle time over ROS: physics is stopped and steps are skipped while the nodes have nothing to do."""

from typing import Optional

import rospy
from std_msgs.msg import Float64, Header

from planar_ros.lockstep.ticker import IDLE_TOPIC
from rospy_transport.connections import outgoing
from sim_bridge.driving.idle_time import idle_seconds, last_steps
from sim_bridge.lock_step import SAME
from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.ros.faults.service import FaultServer
from sim_bridge.ros.robot_manager import RobotManager
from sim_bridge.ros.timing.lock_step import LockStep
from sim_bridge.scene import Scene

# Time without velocity commands and calls after which an idle time may begin [simulated s].
QUIET_SECONDS = 1.0
NEVER = -1.0
# Beginnings of topics without a rate in simulated time, and the clock, which jumps.
WITHOUT_RATE = ("/clock", "/rosout", "/simulation/", "/gazebo/performance_metrics")


class IdleTime:
    """Stops physics while nothing is due, and skips the steps that no other node observes.

    A synchronised node states at a tick, on ``/simulation/idle``, until when it has nothing to do. If it does
    so again at the next tick, once all nodes have answered, an idle time of up to a minute begins: physics is
    stopped, unless it moves something, a fault is active, or a command or call has come within a second. It
    ends in time or with the next command or call. All this depends on simulated time alone.

    Meanwhile steps are skipped, all but those of the last second, in which sensors measure: the scene is the
    same afterwards as if they had been taken. The nodes receive the data of that second at the last tick but
    one, and what they make of them, such as transforms, at the last. No step is skipped while a node listens
    to the robot that is neither synchronised nor an observer.

    Args:
        scene: The simulated world.
        robots: Its robots.
        faults: Its faults.
        lock_step: Synchronised nodes.
        calls: Queue of the thread that owns the scene.
        skips: Whether steps are skipped at all.
    """

    def __init__(
        self,
        scene: Scene,
        robots: RobotManager,
        faults: FaultServer,
        lock_step: LockStep,
        calls: CallQueue,
        skips: bool,
    ):
        self._scene, self._robots, self._faults, self._lock_step = scene, robots, faults, lock_step
        self._calls, self._skips = calls, skips
        self._until: Optional[float] = None
        self._is_expected = False
        self._tick, self._end, self._quiet_from = NEVER, NEVER, 0.0
        self._activity = (0, 0)
        self._skipped = 0.0
        self._without_rate = (f"{rospy.get_name()}/", *WITHOUT_RATE)
        self._skipped_topic = rospy.Publisher("~skipped_seconds", Float64, queue_size=1, latch=True)
        rospy.Subscriber(IDLE_TOPIC, Header, self._on_idle, queue_size=100, tcp_nodelay=True)

    def update(self, longest: float, is_alone: bool) -> Optional[int]:
        """Begin or end an idle time before a step.

        Args:
            longest: Longest time that may be skipped at once [simulated s].
            is_alone: Whether all nodes that simulated time waits for are synchronised.

        Returns:
            Number of steps to skip; None: the answers to the present tick have to come first.
        """
        stamp = self._scene.stamp
        self._end_if_over(stamp, is_alone)
        if not self._lock_step.is_tick(stamp):
            return 0
        if stamp != self._tick:
            self._tick, self._is_expected, self._until = stamp, self._until is not None, None
        if not (self._skippable(stamp, longest) if self._is_idle else self._is_expected):
            return 0
        if not self._lock_step.deliver(stamp):
            return None
        self._end_if_over(stamp, is_alone)
        if not self._is_idle and is_alone:
            self._begin(stamp)
        return self._skippable(stamp, longest)

    def skip(self, count: int) -> None:
        """Skip steps, as many as ``update`` has returned."""
        scene = self._scene
        end = scene.stamp + (count + last_steps(scene.step_seconds)) * scene.step_seconds
        self._lock_step.hold(end - self._lock_step.period)
        self._robots.skip(count)
        self._skipped += count * scene.step_seconds
        self._skipped_topic.publish(self._skipped)

    @property
    def _is_idle(self) -> bool:
        return self._end != NEVER

    def _begin(self, stamp: float) -> None:
        if self._until is None or stamp < self._quiet_from:
            return
        until = min(self._until, self._scene.moves.next_after(stamp))
        seconds = idle_seconds(stamp, until, self._lock_step.period)
        if seconds and self._faults.are_inactive(stamp, stamp + seconds) and self._scene.park():
            self._end = stamp + seconds

    def _end_if_over(self, stamp: float, is_alone: bool) -> None:
        activity = self._calls.acted, self._robots.commands_received
        if activity != self._activity:
            self._activity, self._quiet_from = activity, stamp + QUIET_SECONDS
        if not self._is_idle:
            return
        is_complete = stamp >= self._end - SAME
        if is_complete:  # another one may follow at once
            self._until = stamp
        if is_complete or stamp < self._quiet_from or not (is_alone and self._scene.park()):
            self._end = NEVER
            self._scene.wake()

    def _skippable(self, stamp: float, longest: float) -> int:
        """Return how many steps may be skipped now."""
        if not (self._is_idle and self._skips) or longest == 0.0 or self._has_listeners():
            return 0
        seconds = idle_seconds(stamp, min(self._end, stamp + longest), self._lock_step.period)
        step_seconds = self._scene.step_seconds
        return max(round(seconds / step_seconds) - last_steps(step_seconds), 0)

    def _has_listeners(self) -> bool:
        """Whether a node that is not known listens to the robots or to the state of the world."""
        known = self._lock_step.receivers
        return any(
            receiver not in known and not topic.startswith(self._without_rate)
            for receiver, topic, _ in outgoing()
        )

    def _on_idle(self, message: Header) -> None:
        if f"/{message.frame_id}" in self._lock_step.members:
            until = message.stamp.to_sec()
            self._until = until if self._until is None else min(self._until, until)
