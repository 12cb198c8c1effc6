"""The simulator's part in lock-step: moments, and what takes effect between them."""

import time
from typing import Dict, FrozenSet, List, Optional, Sequence, Set, Tuple

import rospy
from sim_bridge_msgs.msg import Answer, Moment
from std_msgs.msg import Header, String

from planar_ros.messages.conversion import time_of
from planar_ros.step import transport
from planar_ros.step.calls import delay_service_replies
from planar_ros.step.inbox import MessageBuffer
from planar_ros.step.step import STATIC_PUBLISHERS_PARAMETER, WAIT_FOR_PARAMETER
from planar_ros.step.transport import ANSWER_TOPIC, TICK_TOPIC, LockstepConnection
from sim_bridge.coordination import LockStepCoordinator
from sim_bridge.ros.orders import Orders
from sim_bridge.ros.timing.loop_watch import LoopWatch

# Latched: why the run may not be repeatable, one reason a line.
REMARKS_TOPIC = "/simulation/remarks"
# Wall seconds that an answer may take.
PATIENCE_SECONDS = 5.0


class LockStep:
    """Brings ``wait_for``, nodes, into step; its methods are called in the thread that owns the scene.

    ``static_publishers``: nodes whose static transforms they have before time passes.
    """

    def __init__(
        self, wait_for: Sequence[str], static_publishers: Sequence[str], latency: float, orders: Orders
    ):
        self._orders = orders
        self._name = rospy.get_name()
        self._wait_for = frozenset(f"/{name}" for name in wait_for)
        rospy.set_param(WAIT_FOR_PARAMETER, sorted(self._wait_for))
        static = sorted(f"/{name}" for name in static_publishers)
        rospy.set_param(STATIC_PUBLISHERS_PARAMETER, static)
        self._conductor = LockStepCoordinator(latency)
        self._inbox = MessageBuffer(False, self._on_stranger)
        self._inbox.install()
        self._joining: Dict[str, float] = {}
        self._leaving: List[str] = []
        self._topologies: Dict[str, int] = {}
        self._loop = LoopWatch(self._name, self._wait_for, static)
        self._is_applied = True
        self._told: Dict[str, int] = {}
        self._blocked_since: Optional[float] = None
        self._remarks: List[str] = []
        self._noted: Set[str] = set()
        self._moments = rospy.Publisher(TICK_TOPIC, Moment, queue_size=10, tcp_nodelay=True)
        self._remarks_topic = rospy.Publisher(REMARKS_TOPIC, String, queue_size=1, latch=True)
        self._answers = rospy.Subscriber(ANSWER_TOPIC, Answer, self._hear, queue_size=100, tcp_nodelay=True)
        delay_service_replies(lambda number: None)

    @property
    def members(self) -> FrozenSet[str]:
        return self._conductor.members

    @property
    def names(self) -> FrozenSet[str]:
        """Of the members, without the slash."""
        return frozenset(name[1:] for name in self.members)

    @property
    def awaited(self) -> Sequence[str]:
        """The nodes that time stands still for."""
        return self._conductor.pending_nodes() if self._blocked_since is not None else ()

    def waits_for(self) -> List[str]:
        """What time stands still for, for people."""
        return [name[1:] for name in self.awaited] or self._loop.gaps()

    def may_pass(self, stamp: float) -> bool:
        """Whether time may pass ``stamp``; what is due then happens."""
        if self._conductor.is_complete(stamp):
            self._watch_topology(self._name, transport.topology())
        if not self._loop.is_closed:
            for gap in self._loop.given_up():
                self.remark(f"time went on without {gap}")
            return False
        if not self._is_applied and self._conductor.is_complete(stamp) and not self._take_effect(stamp):
            return False
        while self._joining:
            self._conductor.add_node(*self._joining.popitem())
        self._begin_moment(stamp)
        return True

    def restart(self) -> None:
        """Time begins anew."""
        self._conductor.restart()

    def remark(self, text: str) -> None:
        """Tells once why the run may not be repeatable."""
        if text not in self._noted:
            self._noted.add(text)
            self._remarks.append(text)
            rospy.loginfo("this run may not be repeatable: %s", text)
            self._remarks_topic.publish("\n".join(self._remarks))

    def _take_effect(self, stamp: float) -> bool:
        """What the nodes have sent at the latest moment; False if one of them has not finished."""
        awaited = self._conductor.pending_nodes()
        if awaited:
            wall = time.monotonic()
            there = {connection.callerid_pub for connection in self._answers.impl.connections}
            gone = [name for name in awaited if name not in there]
            if gone and not self._orders.are_waiting:
                self._give_up(gone, f"has died at {stamp:.2f} s")
            elif self._blocked_since is None:
                self._blocked_since = wall
            elif wall - self._blocked_since > PATIENCE_SECONDS:
                self._give_up(awaited, f"did not answer for {PATIENCE_SECONDS:g} s at {stamp:.2f} s")
            return False
        self._blocked_since, self._is_applied = None, True
        required: Dict[Tuple[str, str], int] = {}
        for channel, count in self._conductor.effective_counts().items():
            sender, receiver, topic = channel.split(" ")
            if receiver == self._name:
                required[topic, sender] = count
        for loss in self._inbox.release(required):
            self.remark(loss)
        return True

    def _begin_moment(self, stamp: float) -> None:
        begun = self._conductor.begin_tick(stamp)
        if begun is None:
            return
        number, has_new_members = begun
        members = frozenset((self._name, *self.members)) if self.members else frozenset()
        if has_new_members:
            self._inbox.members = LockstepConnection.members = members
            LockstepConnection.audience = self._loop.audience
            self._told.clear()
            if not members:
                self._inbox.release_all()  # the last words of the last one
        transport.flush()
        counts = {**self._conductor.effective_counts(), **transport.sent(self._name)}
        news = {channel: count for channel, count in counts.items() if self._told.get(channel) != count}
        self._told.update(news)
        header, latency = Header(stamp=time_of(stamp)), rospy.Duration(self._conductor.latency)
        self._moments.publish(
            Moment(header, number, latency, sorted(members), list(news), list(news.values()))
        )
        self._is_applied = not members
        while self._leaving:
            self._conductor.remove_node(self._leaving.pop())

    def _give_up(self, names: Sequence[str], why: str) -> None:
        for name in names:
            rospy.logwarn("no progress of %s: the simulation goes on without it in real time", name[1:])
            self.remark(f"{name} {why}")
            self._conductor.remove_node(name)
        self._blocked_since = None

    def _on_stranger(self, text: str) -> None:
        self._orders.leave(lambda: self.remark(text))

    def _hear(self, message: Answer) -> None:
        self._orders.leave(lambda: self._take_answer(message))

    def _take_answer(self, message: Answer) -> None:
        name = message.header.frame_id
        if name not in self._wait_for:
            return
        if message.number:
            sent = dict(zip(message.channels, message.counts))
            self._conductor.acknowledge(name, message.number, sent)
            if not message.period:
                self._leaving.append(name)
        elif name not in self.members and name not in self._joining:
            self._joining[name] = message.period.to_sec()
            self._loop.join(name)
        for text in message.remarks:
            self.remark(text)
        self._watch_topology(name, message.topology)

    def _watch_topology(self, name: str, topology: int) -> None:
        """Topics that are new must be connected before time goes on."""
        if self._topologies.get(name) != topology:
            self._topologies[name] = topology
            self._loop.look_again()
