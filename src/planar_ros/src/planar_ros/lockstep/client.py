"""Lock-step of a node with a simulator; without one, the node processes messages as they arrive."""

import threading
import time
import traceback
import warnings
from contextlib import suppress
from typing import Callable, ClassVar, Dict, FrozenSet, List, Optional, Set, Tuple

import rospy
from sim_bridge_msgs.msg import Answer, Moment
from std_msgs.msg import Header

from planar_ros.lockstep import transport
from planar_ros.lockstep.message_buffer import MessageBuffer
from planar_ros.lockstep.ticker import LockstepThreads, ProgressPublisher, Ticker
from planar_ros.lockstep.transport import (
    ANSWER_TOPIC,
    INSTANT_TOPIC,
    STATIC_TOPIC,
    CallMonitor,
    LockstepConnection,
    call_headers,
    delaying_calls,
)
from rospy_transport.connections import connected_publishers
from rospy_transport.node import is_shutting_down, set_time
from rospy_transport.replacements import install

Hook = Callable[[], None]
TickCallback = Callable[[rospy.Time], None]
POLL_SECONDS = 0.02
# Period of instants for a node without periodic work [simulated s].
DEFAULT_PERIOD = 0.1
# Parameter: nodes that the simulator waits for.
WAIT_FOR_PARAMETER = "/simulation/wait_for"
# Parameter: unsynchronized nodes that must receive all messages; the second name is deprecated.
OBSERVERS_PARAMETER, OLD_OBSERVERS_PARAMETER = "/simulation/observers", "/simulation/audience"
# Parameter: unsynchronized nodes whose static transforms must arrive before the first instant.
STATIC_PUBLISHERS_PARAMETER = "/simulation/static_publishers"
# Time without an instant after which messages of unsynchronized nodes are delivered on arrival [wall s].
STALLED_SECONDS = 0.5
# Longest wait of a service call for its instant [wall s].
CALL_SECONDS = 4.0


class LockstepClient:
    """Synchronizes this node with the simulator at logical instants.

    A node joins (``join``) when it has everything that takes no simulated time; the simulator advances no
    time before. While the node is synchronized, each instant proceeds as follows:

    1. The messages of the instant are delivered to the callbacks, in one thread and always in the same order.
    2. The callbacks of ``on_instant`` and ``every`` are called.
    3. Threads that take turns run until they ``pause``.
    4. The messages sent meanwhile go out together with the answer.

    ROS time is the time of the instant.
    """

    _instance: ClassVar[Optional["LockstepClient"]] = None

    def __init__(self):
        self._latency = 0.0
        self._name = rospy.get_name()
        self._buffer = MessageBuffer(True, lambda text: self.add_remark(f"{self._name} {text}"))
        self._threads = LockstepThreads()
        self._progress = ProgressPublisher()
        self._hooks: List[Hook] = []
        self._required: Dict[Tuple[str, str], int] = {}
        self._reported_counts: Dict[str, int] = {}
        self._remarks: Set[str] = set()
        self._pending: List[Hook] = []
        self._periods: List[Callable[[], float]] = []
        self._number, self._answered, self._answered_at = 0, 0, 0.0
        self._working = threading.Condition()
        self._answers: Optional[rospy.Publisher] = None
        if rospy.get_param("/use_sim_time", False):
            monitor = CallMonitor(lambda: self._buffer.members, self.add_remark)
            install(LockstepConnection, self._buffer.receive, delaying_calls(self._await_answer, monitor))
            self._answers = rospy.Publisher(ANSWER_TOPIC, Answer, queue_size=10, tcp_nodelay=True)
            rospy.Subscriber(INSTANT_TOPIC, Moment, self._on_instant, queue_size=100, tcp_nodelay=True)
            rospy.on_shutdown(self._answer_last)

    @classmethod
    def of_node(cls) -> "LockstepClient":
        """Return the client of this node; the first call must precede all subscriptions."""
        if cls._instance is None:
            cls._instance = cls()
        return cls._instance

    @classmethod
    def existing(cls) -> Optional["LockstepClient"]:
        """Return the client of this node; None if there is none."""
        return cls._instance

    @property
    def is_synchronized(self) -> bool:
        """Whether the node is synchronized."""
        return bool(self._buffer.members)

    @property
    def latency(self) -> float:
        """Simulated time until messages of this node take effect [s]."""
        return self._latency if self.is_synchronized else 0.0

    def join(self, is_ready: Callable[[], bool] = lambda: True, takes_turns: bool = False) -> None:
        """Ask the simulator to synchronize with this node.

        Args:
            is_ready: The node joins as soon as it returns True.
            takes_turns: Whether the calling thread takes turns: an instant is not answered while it works.
        """
        if self._answers is None:
            return
        if takes_turns:
            self._threads.register()
        threading.Thread(target=self._run, args=(is_ready,), daemon=True).start()

    def on_instant(self, hook: Hook) -> None:
        """Call a function at every instant, after its messages were delivered."""
        self._hooks.append(hook)

    def every(
        self,
        period: Callable[[], float],
        tick: TickCallback,
        on_time_jump: Hook = lambda: None,
        reports: bool = False,
        afresh: Optional[Hook] = None,
    ) -> None:
        """Call a function periodically in ROS time.

        Args:
            period: Returns the current period [s].
            tick: Called with the current time.
            on_time_jump: Called when time has jumped back.
            reports: Whether the node has worked up to the current time after each tick.
            afresh: Deprecated name of ``on_time_jump``.
        """
        if afresh is not None:
            text = "the argument afresh is deprecated; use on_time_jump"
            warnings.warn(text, DeprecationWarning, stacklevel=2)
        self._periods.append(period)
        ticker = Ticker(period, tick, afresh or on_time_jump)
        self.on_instant(ticker.poll)
        ticker.start(lambda: self.is_synchronized, self.report if reports else lambda now: None)

    def pause(self, seconds: float) -> None:
        """End the turn of the calling thread until the next instant; without lock-step, sleep ``seconds``."""
        if self._threads.is_registered():
            self._threads.wait_for_turn(lambda: not self.is_synchronized or rospy.is_shutdown())
        if not self.is_synchronized:
            time.sleep(seconds)

    def defer(self, hook: Hook) -> None:
        """Call a function at the end of the instant; if not synchronized, in another thread."""
        if self.is_synchronized:
            self._pending.append(hook)
        else:
            threading.Thread(target=hook, daemon=True).start()

    def report(self, stamp: rospy.Time) -> None:
        """Report progress up to ``stamp`` to a simulator if the node is not synchronized."""
        if not self.is_synchronized:
            self._progress.report(stamp)

    def headers(self) -> Dict[str, str]:
        """Return the headers of a service call at this instant."""
        return call_headers(self._number if self.is_synchronized else 0)

    def add_remark(self, text: str) -> None:
        """Record why this run may not be repeatable."""
        self._remarks.add(text)

    def _run(self, is_ready: Callable[[], bool]) -> None:
        """Ask to join while the node is not synchronized; otherwise serve unsynchronized nodes."""
        while not is_shutting_down():
            if self.is_synchronized:
                self._serve_unsynchronized()
            elif is_ready():
                with self._working:  # so that the first instant does not arrive in between
                    self._answer(rospy.Time(0)) if not self.is_synchronized else None
            time.sleep(POLL_SECONDS)

    def _on_instant(self, message: Moment) -> None:
        members = frozenset(message.members)
        if self._name not in members:
            if self.is_synchronized:
                self._leave()
            return
        with self._working:
            transport.batch_sends()
            self._begin(message, members)
            self._work()
            transport.flush()
            self._answer(message.header.stamp)
            self._answered, self._answered_at = self._number, time.monotonic()
            self._working.notify_all()

    def _begin(self, message: Moment, members: FrozenSet[str]) -> None:
        """Deliver the messages of an instant."""
        initial = {} if self.is_synchronized else _initial_messages()
        if members != self._buffer.members:
            self._buffer.members = LockstepConnection.members = members
            LockstepConnection.observers = observers()
            self._required.clear()
            self._reported_counts.clear()
        self._required.update(_sent_to(self._name, message))
        self._number, self._latency = message.number, message.latency.to_sec()
        set_time(message.header.stamp)
        for missing in self._buffer.release({**initial, **self._required}):
            rospy.logwarn("at %.2f s: %s", message.header.stamp.to_sec(), missing)
            self.add_remark(f"{self._name}: {missing}")

    def _work(self) -> None:
        for hook in tuple(self._hooks):
            _call(hook)
        self._threads.run_turn(lambda: not self.is_synchronized or rospy.is_shutdown())
        while self._pending:
            _call(self._pending.pop(0))

    def _answer_last(self) -> None:
        """Send the last answer, so that sent messages take effect and the simulator does not wait."""
        if self.is_synchronized:
            transport.flush()
            self._answer(rospy.Time.now(), is_last=True)

    def _answer(self, stamp: rospy.Time, is_last: bool = False) -> None:
        sent = transport.sent(self._name)
        changed = {
            channel: count for channel, count in sent.items() if self._reported_counts.get(channel) != count
        }
        self._reported_counts.update(changed)
        remarks, self._remarks = self._remarks, set()
        period = 0.0 if is_last else min((period() for period in self._periods), default=DEFAULT_PERIOD)
        header = Header(stamp=stamp, frame_id=self._name)
        number = self._number if self.is_synchronized else 0
        content = transport.topology(), list(changed), list(changed.values()), sorted(remarks)
        answer = Answer(header, number, rospy.Duration(period), *content)
        with suppress(rospy.ROSException):  # rospy closed the topic during shutdown
            if self._answers is not None:
                self._answers.publish(answer)

    def _leave(self) -> None:
        """Continue without lock-step, since the simulator stopped waiting, and ask to join again."""
        if not is_shutting_down():
            rospy.logwarn("the simulation no longer waits for this node; asking to join again")
        LockstepConnection.members = frozenset()
        transport.flush()
        self._buffer.release_all()
        self._threads.notify()
        with self._working:
            self._working.notify_all()

    def _await_answer(self, number: int) -> None:
        """Wait until the instant with this number has been answered."""
        with self._working:
            self._working.wait_for(lambda: self._answered >= number or not self.is_synchronized, CALL_SECONDS)

    def _serve_unsynchronized(self) -> None:
        """Deliver messages of unsynchronized nodes while there are no instants, as in a paused simulation."""
        time.sleep(STALLED_SECONDS)
        with self._working:
            if self.is_synchronized and time.monotonic() - self._answered_at > STALLED_SECONDS:
                self._buffer.release_unsynchronized()
                transport.flush()


def has_synchronized_publisher(topic: rospy.Subscriber) -> bool:
    """Return whether a synchronized node publishes on the topic, so that its messages take simulated time."""
    return not connected_publishers(topic).isdisjoint(rospy.get_param(WAIT_FOR_PARAMETER, []))


def observers() -> FrozenSet[str]:
    """Return the unsynchronized nodes that must receive all messages."""
    return frozenset(rospy.get_param(OBSERVERS_PARAMETER, []) or rospy.get_param(OLD_OBSERVERS_PARAMETER, []))


def _initial_messages() -> Dict[Tuple[str, str], int]:
    """Return the messages that must arrive before a node works for the first time."""
    return {(STATIC_TOPIC, name): 1 for name in rospy.get_param(STATIC_PUBLISHERS_PARAMETER, [])}


def _sent_to(receiver: str, message: Moment) -> Dict[Tuple[str, str], int]:
    """Return the number of messages sent to a node according to an instant, by topic and sender."""
    channels = [channel.split(" ") for channel in message.channels]
    return {
        (topic, sender): count
        for (sender, to, topic), count in zip(channels, message.counts)
        if to == receiver
    }


def _call(hook: Hook) -> None:
    """Call a function; an exception does not prevent the others, as with rospy's callbacks."""
    try:
        hook()
    except Exception:
        if not rospy.is_shutdown():
            rospy.logerr("exception at a logical instant: %s", traceback.format_exc())
