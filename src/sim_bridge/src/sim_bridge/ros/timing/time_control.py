"""Control of simulated time: pausing, stepping, resetting, and the speed."""

import math
import time
from concurrent.futures import CancelledError, Future
from dataclasses import dataclass
from typing import Callable, FrozenSet, List, Optional

import rospy
from rosgraph_msgs.msg import Clock
from sim_bridge_msgs.srv import Step, StepResponse
from std_msgs.msg import Float64, Header

from planar_ros.lockstep import transport
from planar_ros.lockstep.ticker import PROGRESS_TOPIC
from planar_ros.messages.conversion import time_of
from planar_ros.node.parameters import SettingsReconfigureServer
from planar_ros.node.readiness import ReadinessMonitor, StallReporter
from rospy_transport.connections import outgoing
from sim_bridge.config import RunTimeSettings
from sim_bridge.pacing import REAL_TIME, Pacer
from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.ros.timing.idle_time import IdleTime
from sim_bridge.ros.timing.lock_step import LockStep
from sim_bridge.ros.timing.paced_nodes import Before, PacedNodes
from sim_bridge.scene import Scene

# Longest single wait [wall s], so that a shutdown is noticed soon.
LONGEST_WAIT_SECONDS = 0.05


@dataclass
class _StepRequest:
    """A call of ``~step``: steps still to take, and a future of the simulated time after the last of them."""

    steps_left: int
    done: Future


class TimeControl:
    """Decides when the next step is due; its methods are called in the thread that owns the scene.

    Args:
        scene: The simulated world.
        pacer: Limits the speed.
        lock_step: Synchronised nodes.
        paced: Nodes that are not synchronised, and waited for.
        idle: Idle time of the synchronised nodes.
        calls: Queue of the thread that owns the scene.
        clock_steps: Number of steps between two messages of ``/clock``.
    """

    def __init__(
        self,
        scene: Scene,
        pacer: Pacer,
        lock_step: LockStep,
        paced: PacedNodes,
        idle: IdleTime,
        calls: CallQueue,
        clock_steps: int,
    ):
        self.is_paused = False
        self._clock = rospy.Publisher("/clock", Clock, queue_size=10, latch=True, tcp_nodelay=True)
        self._clock_steps, self._steps = clock_steps, 0
        self._is_clock_due = self._is_clock_sent = self._is_clock_processed = False
        self._lock_step = lock_step
        self._paced, self._idle = paced, idle
        self._scene = scene
        self._pacer = pacer
        self._calls = calls
        self._requests: List[_StepRequest] = []
        self._deferred: Optional[Callable[[], None]] = None
        self._held_at = math.inf
        rospy.Subscriber(transport.HOLD_TOPIC, Float64, self._on_hold, queue_size=10, tcp_nodelay=True)
        rospy.Subscriber(PROGRESS_TOPIC, Header, self._on_progress, queue_size=100, tcp_nodelay=True)
        rospy.Service("~step", Step, self._on_step)
        self._stall_reporter = StallReporter()
        ReadinessMonitor({f"{name} on {PROGRESS_TOPIC}": self._is_followed(name) for name in pacer.wait_for})

    @property
    def speed(self) -> float:
        return self._pacer.speed

    def set_speed(self, speed: float) -> None:
        """Set the speed as a multiple of real time; 0 for as fast as possible."""
        self._pacer.speed = speed

    def advertise_speed(self) -> None:
        """Make the speed a parameter of dynamic_reconfigure."""
        SettingsReconfigureServer(RunTimeSettings(self.speed), self._on_reconfigure)

    def set_odometry_period(self, seconds: float) -> None:
        """Set the longest time between two odometry messages of a robot [simulated s]."""
        self._pacer.odometry_delay = max(0.0, seconds - self._scene.step_seconds)

    def wait_for_step(self) -> bool:
        """Wait until the next step may be taken; return False if pending calls have to be run first."""
        may_step = self._may_step()
        self._stall_reporter.update([] if may_step else self._waiting_for())
        return may_step

    def may_defer(self, topics: FrozenSet[str]) -> bool:
        """Return whether topics may be published later: nodes receive them that are not synchronised."""
        receivers = {receiver for receiver, topic, _ in outgoing() if topic in topics}
        return not self._requests and self._paced.may_await(receivers)

    def defer(self, publish: Callable[[], None]) -> None:
        """Publish a part of a step when the nodes that are not synchronised have processed the other part.

        A message filter of tf2_ros (0.7.6) loses a scan if its transform arrives, in another thread, while
        the filter adds it.
        """
        self._deferred = publish

    def _may_step(self) -> bool:
        if self._deferred is not None:
            if not self._have_nodes_rested(Before.SENSORS):
                return self._wait(self._paced.pause)
            self._deferred()
            self._deferred = None
        if self._is_clock_due:
            if not self._have_nodes_rested(Before.CLOCK):
                return self._wait(self._paced.pause)
            self._publish_clock()
        if self.is_paused and not self._requests:
            return self._wait(LONGEST_WAIT_SECONDS)
        if not self._is_clock_processed and self._lock_step.is_tick_due(self._scene.stamp):
            # What other nodes send at this time must not race with the tick of the nodes that receive it.
            if not self._have_nodes_rested(Before.TICK):
                return self._wait(self._paced.pause)
            self._is_clock_processed = True
        if not self._lock_step.may_step(self._scene.stamp):
            return self._wait(LONGEST_WAIT_SECONDS)
        if self._calls.has_pending:  # of what was just delivered
            return self._wait(0.0)
        if not self._have_nodes_rested(Before.STEP):
            return self._wait(self._paced.pause)
        self._pacer.synchronised_nodes = self._lock_step.member_names | self._paced.names
        self._pacer.limited_by = self._paced.limiting
        if self._is_held:
            return self._wait(LONGEST_WAIT_SECONDS)
        longest = 0.0 if self.is_paused or self._held_at < math.inf else self._pacer.longest_jump
        skipped = self._idle.update(longest, not self._paced.are_any)
        if skipped is None or self._calls.has_pending:
            return self._wait(LONGEST_WAIT_SECONDS)
        wall, stamp = time.monotonic(), self._scene.stamp + (skipped + 1) * self._scene.step_seconds
        delay = self._pacer.delay(stamp, wall, is_limited=not self.is_paused)
        if delay <= 0.0:
            self._skip(skipped)
            return True
        for name in self._pacer.give_up(stamp, wall):
            rospy.logwarn("no progress of %s: the simulation goes on without it in real time", name)
        return self._wait(min(delay, LONGEST_WAIT_SECONDS))

    @property
    def _is_held(self) -> bool:
        """Whether the next step would pass the time of ``transport.HOLD_TOPIC``; the first one always may."""
        return self._steps > 0 and self._scene.stamp + 0.5 * self._scene.step_seconds > self._held_at

    def _on_hold(self, message: Float64) -> None:
        self._calls.submit(lambda: setattr(self, "_held_at", message.data), acts=False)

    def _skip(self, count: int) -> None:
        """Skip steps of an idle time."""
        if count:
            self._idle.skip(count)
            self._steps += count

    def _have_nodes_rested(self, before: Before) -> bool:
        """Whether nodes have caught up that neither support lock-step nor report; not asked in real time."""
        if 0.0 < self.speed <= REAL_TIME:
            return True
        reporting = {f"/{name}" for name in self._pacer.reporting}
        synchronised = self._lock_step.members | reporting
        self._paced.set_nodes(self._lock_step.unable - reporting, synchronised, self._lock_step.callers)
        return self._paced.have_rested(
            before, self._scene.stamp, self._lock_step.is_answered, self._is_clock_sent
        )

    def _publish_clock(self) -> None:
        self._is_clock_due, self._is_clock_sent = False, True
        self._clock.publish(time_of(self._scene.stamp))

    def _wait(self, seconds: float) -> bool:
        """Send what has been published, wait for calls, at most ``seconds``, and return False."""
        transport.flush()
        self._calls.wait(seconds)
        return False

    def _waiting_for(self) -> List[str]:
        if (self.is_paused or self._is_held) and not self._requests:
            return []
        return [
            *self._lock_step.waiting_for(),
            *self._paced.waiting_for(),
            *self._pacer.lagging_nodes(self._scene.stamp + self._scene.step_seconds),
        ]

    def on_step_finished(self) -> None:
        """Count a step whose data has been published, and answer the calls of ``~step`` that are finished.

        The time comes last, so that nodes which it wakes up find the data of this step. That of the first
        step is always sent: before it no timer of roscpp runs, such as the one for static transforms.
        """
        self._steps += 1
        self._is_clock_sent = self._is_clock_processed = False
        if self._steps == 1 or self._steps % self._clock_steps == 0:
            self._is_clock_due = True
            if not self._paced.are_any:
                self._publish_clock()
        if self._requests:
            self._requests[0].steps_left -= 1
            self._answer_finished()

    def pause(self) -> None:
        self.is_paused = True

    def unpause(self) -> None:
        self.is_paused = False

    def reset_world(self) -> None:
        self._scene.reset_poses()
        rospy.loginfo("all models are back at their initial poses")

    def reset_simulation(self) -> None:
        self._scene.reset()
        self._is_clock_due, self._deferred = False, None
        self._pacer.reset()
        self._lock_step.reset_time()
        self._paced.reset_time()
        rospy.loginfo("the simulation starts again at time 0")

    def close(self) -> None:
        """Refuse the calls of ``~step`` that are not finished."""
        for request in self._requests:
            request.done.cancel()

    def _on_step(self, message) -> StepResponse:
        """Pause, and take steps as fast as the nodes that are waited for allow."""
        request = _StepRequest(message.steps, Future())
        self._calls.call(lambda: self._add_request(request), acts=False)
        try:
            return StepResponse(time_of(request.done.result()))
        except CancelledError:
            raise rospy.ServiceException("the simulation is shutting down") from None

    def _on_reconfigure(self, values):
        self._calls.submit(lambda: self.set_speed(values["speed"]), acts=False)
        return values

    def _add_request(self, request: _StepRequest) -> None:
        self.is_paused = True
        self._requests.append(request)
        self._answer_finished()

    def _answer_finished(self) -> None:
        while self._requests and self._requests[0].steps_left == 0:
            self._requests.pop(0).done.set_result(self._scene.stamp)

    def _on_progress(self, message):
        name, stamp = message.frame_id.lstrip("/"), message.stamp.to_sec()
        self._calls.submit(lambda: self._pacer.report(name, stamp), acts=False)

    def _is_followed(self, name):
        return lambda: name in self._lock_step.member_names or not self._pacer.is_missing(name)
