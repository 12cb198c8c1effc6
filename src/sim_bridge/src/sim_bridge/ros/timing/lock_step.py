"""Lock-step with the simulator, the simulator's side: ticks, and the delivery of messages between them.

Protocol (docs/explanation/deterministic_runs.md): the simulator publishes each tick on
``/simulation/moment``, and every synchronised node answers on ``/simulation/answer`` when it has finished
its work. The nodes' side is ``planar_ros.lockstep``; ``sim_bridge.lock_step`` decides which tick is due.
"""

import time
from typing import Dict, FrozenSet, List, Optional, Sequence, Set, Tuple

import rospy
from sim_bridge_msgs.msg import Answer, Moment
from std_msgs.msg import Header, String

from planar_ros.lockstep import transport
from planar_ros.lockstep.client import STATIC_PUBLISHERS_PARAMETER, WAIT_FOR_PARAMETER
from planar_ros.lockstep.message_buffer import MessageBuffer
from planar_ros.lockstep.transport import (
    ANSWER_TOPIC,
    INSTANT_TOPIC,
    CallMonitor,
    LockstepConnection,
    delaying_calls,
)
from planar_ros.messages.conversion import time_of
from rospy_transport.connections import connected_publishers
from rospy_transport.replacements import install
from sim_bridge.lock_step import LockStepCoordinator
from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.ros.timing.connection_monitor import ConnectionMonitor

# Latched: why the run may not be repeatable, one reason a line.
REMARKS_TOPIC = "/simulation/remarks"
# Beside nodes that are not synchronised, ticks come this much after the scans [simulated s]: a loop that a
# goal starts in such a node then has no instant in common with those that a scan has started, if the clock is
# sent at each step.
DELAY_BESIDE_OTHERS = 0.02
# Time limit of an answer [wall s].
ANSWER_SECONDS = 5.0


class LockStep:
    """Synchronises nodes with the simulation; its methods are called in the thread that owns the scene.

    Args:
        wait_for: Names of the nodes to synchronise, without slash.
        static_publishers: Names of nodes whose static transforms must have arrived before time passes.
        latency: Time between a tick and the delivery of the messages sent at it [simulated s].
        calls: Queue of the thread that owns the scene.
    """

    def __init__(
        self, wait_for: Sequence[str], static_publishers: Sequence[str], latency: float, calls: CallQueue
    ):
        self._calls = calls
        self._name = rospy.get_name()
        self._wait_for = frozenset(f"/{name}" for name in wait_for)
        rospy.set_param(WAIT_FOR_PARAMETER, sorted(self._wait_for))
        self._static_publishers = static = sorted(f"/{name}" for name in static_publishers)
        rospy.set_param(STATIC_PUBLISHERS_PARAMETER, static)
        self._coordinator = LockStepCoordinator(latency)
        self._inbox = MessageBuffer(False, self._on_unsynchronised)
        install(receive=self._inbox.receive)
        self._joining: Dict[str, float] = {}
        self._leaving: List[str] = []
        self._topologies: Dict[str, int] = {}
        self._connections = ConnectionMonitor(self._name, self._wait_for, static)
        self._delivered = True
        self._published_counts: Dict[str, int] = {}
        self._blocked_since: Optional[float] = None
        self._remarks: List[str] = []
        self._known_remarks: Set[str] = set()
        self._moments = rospy.Publisher(INSTANT_TOPIC, Moment, queue_size=10, tcp_nodelay=True)
        self._remarks_topic = rospy.Publisher(REMARKS_TOPIC, String, queue_size=1, latch=True)
        self._answers = rospy.Subscriber(
            ANSWER_TOPIC, Answer, self._on_answer, queue_size=100, tcp_nodelay=True
        )
        speed = f"{self._name}/set_parameters"
        self._monitor = CallMonitor(self._synchronised_nodes, self._on_unsynchronised, harmless=(speed,))
        install(before_call=delaying_calls(lambda number: None, self._monitor))

    @property
    def members(self) -> FrozenSet[str]:
        """Names of the synchronised nodes."""
        return self._coordinator.members

    @property
    def member_names(self) -> FrozenSet[str]:
        """Names of the synchronised nodes, without slash."""
        return frozenset(name[1:] for name in self.members)

    @property
    def unable(self) -> FrozenSet[str]:
        """Names of the nodes to synchronise that do not support it."""
        return self._connections.unable

    @property
    def callers(self) -> FrozenSet[str]:
        """Names of the nodes that are not synchronised and have called the simulator's services."""
        return self._monitor.callers

    @property
    def is_answered(self) -> bool:
        """Whether all synchronised nodes have answered the latest tick."""
        return self._delivered or not self._coordinator.unanswered()

    @property
    def awaited(self) -> Sequence[str]:
        """The nodes for whose answers simulated time is stopped."""
        return self._coordinator.unanswered() if self._blocked_since is not None else ()

    def waiting_for(self) -> List[str]:
        """Return what simulated time is stopped for, as texts for a log."""
        return [name[1:] for name in self.awaited] or self._connections.missing()

    def may_step(self, stamp: float) -> bool:
        """Return whether the next step may be taken; make the deliveries and begin the ticks that are due.

        Args:
            stamp: Present simulated time [s].
        """
        if self._coordinator.delivery_due(stamp):
            self._check_topology(self._name, transport.topology())
        for shortcoming in self._connections.shortcomings():
            self.add_remark(shortcoming)
        if not self._connections.is_complete:
            return False
        if not self._delivered and self._coordinator.delivery_due(stamp) and not self._deliver(stamp):
            return False
        while self._joining:
            self._coordinator.add_member(*self._joining.popitem())
        self._begin_tick(stamp)
        return True

    def is_tick_due(self, stamp: float) -> bool:
        """Return whether a tick begins at ``stamp`` [simulated s]."""
        return self._coordinator.tick_due(stamp)

    @property
    def period(self) -> float:
        """Time between two ticks [simulated s]."""
        return self._coordinator.period

    @property
    def receivers(self) -> FrozenSet[str]:
        """Names of the nodes known to receive messages: synchronised nodes, observers, static publishers."""
        return frozenset((self._name, *self.members, *self._connections.observers, *self._static_publishers))

    def is_tick(self, stamp: float) -> bool:
        """Return whether the latest tick began at ``stamp`` [simulated s]."""
        return bool(self.members) and self._coordinator.is_tick(stamp)

    def deliver(self, stamp: float) -> bool:
        """Deliver the messages of the latest tick before their time; return False until all have answered.

        Args:
            stamp: Present simulated time [s].
        """
        return self._delivered or self._deliver(stamp)

    def hold(self, until: float) -> None:
        """Begin no tick before ``until`` [simulated s]; the messages of the latest one are delivered."""
        assert self._delivered, "messages would wait meanwhile"
        self._coordinator.hold(until)

    def reset_time(self) -> None:
        """Restart simulated time at 0."""
        self._coordinator.reset_time()

    def add_remark(self, text: str) -> None:
        """Publish and log, once, why the run may not be repeatable."""
        if text not in self._known_remarks:
            self._known_remarks.add(text)
            self._remarks.append(text)
            rospy.loginfo("this run may not be repeatable: %s", text)
            self._remarks_topic.publish("\n".join(self._remarks))

    def _deliver(self, stamp: float) -> bool:
        """Deliver the messages of the latest tick; return False if a node has not answered it yet."""
        unanswered = self._coordinator.unanswered()
        if unanswered:
            wall = time.monotonic()
            connected = connected_publishers(self._answers)
            gone = [name for name in unanswered if name not in connected]
            if gone and not self._calls.has_pending:
                self._drop(gone, f"has died at {stamp:.2f} s")
            elif self._blocked_since is None:
                self._blocked_since = wall
            elif wall - self._blocked_since > ANSWER_SECONDS:
                self._drop(unanswered, f"did not answer for {ANSWER_SECONDS:g} s at {stamp:.2f} s")
            return False
        self._blocked_since, self._delivered = None, True
        required: Dict[Tuple[str, str], int] = {}
        for channel, count in self._coordinator.sent_counts().items():
            sender, receiver, topic = channel.split(" ")
            if receiver == self._name:
                required[topic, sender] = count
        for loss in self._inbox.release(required):
            self.add_remark(loss)
        return True

    def _begin_tick(self, stamp: float) -> None:
        self._coordinator.delay = DELAY_BESIDE_OTHERS if self.unable else 0.0
        begun = self._coordinator.begin_tick(stamp)
        if begun is None:
            return
        number, members_changed = begun
        members = frozenset((self._name, *self.members)) if self.members else frozenset()
        if members_changed:
            self._inbox.members = LockstepConnection.members = members
            LockstepConnection.observers = self._connections.observers
            self._published_counts.clear()
            if not members:
                self._inbox.release_all()  # what the last member sent before it left
        transport.flush()
        counts = {**self._coordinator.sent_counts(), **transport.sent(self._name)}
        changed = {
            channel: count
            for channel, count in counts.items()
            if self._published_counts.get(channel) != count
        }
        self._published_counts.update(changed)
        header, latency = Header(stamp=time_of(stamp)), rospy.Duration(self._coordinator.latency)
        self._moments.publish(
            Moment(header, number, latency, sorted(members), list(changed), list(changed.values()))
        )
        self._delivered = not members
        while self._leaving:
            self._coordinator.remove_member(self._leaving.pop())

    def _drop(self, names: Sequence[str], why: str) -> None:
        """Remove nodes that do not answer."""
        for name in names:
            rospy.logwarn("no progress of %s: the simulation goes on without it in real time", name[1:])
            self.add_remark(f"{name} {why}")
            self._coordinator.remove_member(name)
        self._blocked_since = None

    def _synchronised_nodes(self) -> FrozenSet[str]:
        """Return the nodes whose calls are not noted, those that are about to be synchronised among them."""
        return self.members | self._wait_for | {self._name} if self.members else frozenset()

    def _on_unsynchronised(self, text: str) -> None:
        self._calls.submit(lambda: self.add_remark(text), acts=False)

    def _on_answer(self, message: Answer) -> None:
        self._calls.submit(lambda: self._process_answer(message), acts=False)

    def _process_answer(self, message: Answer) -> None:
        name = message.header.frame_id
        if name not in self._wait_for:
            return
        if message.number:
            sent = dict(zip(message.channels, message.counts))
            self._coordinator.record_answer(name, message.number, sent)
            if not message.period:
                self._leaving.append(name)
        elif name not in self.members and name not in self._joining:
            self._joining[name] = message.period.to_sec()
            self._connections.add_node(name)
        for text in message.remarks:
            self.add_remark(text)
        self._check_topology(name, message.topology)

    def _check_topology(self, name: str, topology: int) -> None:
        """Have connections checked again when a node has other topics."""
        if self._topologies.get(name) != topology:
            self._topologies[name] = topology
            self._connections.recheck()
