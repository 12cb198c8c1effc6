"""A node's part in lock-step with a simulator; without one the node works as it comes."""

import threading
import time
import traceback
from contextlib import suppress
from typing import Callable, ClassVar, Dict, FrozenSet, List, Optional, Set, Tuple

import rospy
from sim_bridge_msgs.msg import Answer, Moment
from std_msgs.msg import Header

from planar_ros.lockstep import transport
from planar_ros.lockstep.message_buffer import MessageBuffer
from planar_ros.lockstep.service_calls import CallMonitor, call_headers, delay_service_replies
from planar_ros.lockstep.threads import LockstepThreads
from planar_ros.lockstep.ticker import ProgressPublisher, Ticker
from planar_ros.lockstep.transport import ANSWER_TOPIC, INSTANT_TOPIC, STATIC_TOPIC, LockstepConnection

Hook = Callable[[], None]
TickCallback = Callable[[rospy.Time], None]
POLL_SECONDS = 0.02
# Simulated seconds between two moments that a node needs which does not say.
DEFAULT_PERIOD = 0.1
# The nodes that the simulator waits for.
WAIT_FOR_PARAMETER = "/simulation/wait_for"
# Nodes outside that are to miss nothing.
OBSERVERS_PARAMETER = "/simulation/audience"
# Nodes that are not in step, whose static transforms are heard before the first moment is worked on.
STATIC_PUBLISHERS_PARAMETER = "/simulation/static_publishers"
# Wall seconds without a moment after which messages of strangers are handed on as they come.
STALLED_SECONDS = 0.5
# Wall seconds that a call from a node in step may have to wait for the moment it belongs to.
CALL_SECONDS = 4.0


class LockstepClient:
    """The one of this node: takes in what belongs to each moment, has the node work, and answers.

    A node asks to be in step (``join``) when it has all that does not take simulated time; the simulator lets
    no time pass before. In step, messages are handed to callbacks at moments only, in one thread and always
    in the same order; then the node's hooks are called (``at_moments``, ``every``), then threads that take
    turns go on until they ``pause``; what they send goes out with the answer. ROS time is the moment's.
    """

    _instance: ClassVar[Optional["LockstepClient"]] = None

    def __init__(self):
        self._latency = 0.0
        self._name = rospy.get_name()
        self._buffer = MessageBuffer(True, lambda text: self.add_remark(f"at {self._name} {text}"))
        self._threads = LockstepThreads()
        self._progress = ProgressPublisher()
        self._hooks: List[Hook] = []
        self._required: Dict[Tuple[str, str], int] = {}
        self._told: Dict[str, int] = {}
        self._remarks: Set[str] = set()
        self._pending: List[Hook] = []
        self._periods: List[Callable[[], float]] = []
        self._number, self._answered, self._answered_at = 0, 0, 0.0
        self._working = threading.Condition()
        self._answers: Optional[rospy.Publisher] = None
        if rospy.get_param("/use_sim_time", False):
            transport.install()
            self._buffer.install()
            monitor = CallMonitor(lambda: self._buffer.members, self.add_remark)
            delay_service_replies(self._await_answer, monitor)
            self._answers = rospy.Publisher(ANSWER_TOPIC, Answer, queue_size=10, tcp_nodelay=True)
            rospy.Subscriber(INSTANT_TOPIC, Moment, self._on_moment, queue_size=100, tcp_nodelay=True)
            rospy.on_shutdown(self._take_leave)

    @classmethod
    def of_node(cls) -> "LockstepClient":
        """The node's own; the first call must come before all subscriptions."""
        if cls._instance is None:
            cls._instance = cls()
        return cls._instance

    @classmethod
    def existing(cls) -> Optional["LockstepClient"]:
        """The node's own, None if it has none."""
        return cls._instance

    @property
    def is_synchronized(self) -> bool:
        """Whether the node is in step."""
        return bool(self._buffer.members)

    @property
    def latency(self) -> float:
        """Seconds until what the node sends takes effect."""
        return self._latency if self.is_synchronized else 0.0

    def join(self, is_ready: Callable[[], bool] = lambda: True, takes_turns: bool = False) -> None:
        """Asks to be in step as soon as the node ``is_ready``.

        With ``takes_turns`` the calling thread does: no answer is given while it works.
        """
        if self._answers is None:
            return
        if takes_turns:
            self._threads.register()
        threading.Thread(target=self._ask, args=(is_ready,), daemon=True).start()

    def on_instant(self, hook: Hook) -> None:
        """``hook`` is called at every moment, when what belongs to it has been taken in."""
        self._hooks.append(hook)

    def every(
        self, period: Callable[[], float], tick: TickCallback, on_time_jump: Hook, reports: bool = False
    ) -> None:
        """Call ``tick(now)`` every ``period()`` seconds of ROS time, ``on_time_jump()`` when time jumps back.

        If it ``reports``, the node has then worked up to this time.
        """
        self._periods.append(period)
        ticker = Ticker(period, tick, on_time_jump)
        self.on_instant(ticker.poll)
        ticker.start(lambda: self.is_synchronized, self.report if reports else lambda now: None)

    def pause(self, seconds: float) -> None:
        """Ends the turn of the calling thread until the next moment; out of step, for ``seconds``."""
        if self._threads.is_registered():
            self._threads.wait_for_turn(lambda: not self.is_synchronized or rospy.is_shutdown())
        if not self.is_synchronized:
            time.sleep(seconds)

    def defer(self, do: Hook) -> None:
        """Calls it when the caller is done: at the end of the moment; out of step, in another thread."""
        if self.is_synchronized:
            self._pending.append(do)
        else:
            threading.Thread(target=do, daemon=True).start()

    def report(self, stamp: rospy.Time) -> None:
        """Out of step: tells a simulator that the node has worked up to ``stamp``."""
        if not self.is_synchronized:
            self._progress.report(stamp)

    def headers(self) -> Dict[str, str]:
        """What a call of a service has to carry now."""
        return call_headers(self._number if self.is_synchronized else 0)

    def add_remark(self, text: str) -> None:
        """Says why this run may not be repeatable."""
        self._remarks.add(text)

    def _ask(self, is_ready: Callable[[], bool]) -> None:
        """Again and again while the node is not in step; in it, minds strangers."""
        while not rospy.core.is_shutdown_requested():
            if self.is_synchronized:
                self._mind_strangers()
            elif is_ready():
                with self._working:  # lest the first moment comes in between
                    self._answer(rospy.Time(0)) if not self.is_synchronized else None
            time.sleep(POLL_SECONDS)

    def _on_moment(self, message: Moment) -> None:
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
        """Takes in what belongs to the moment."""
        first_words = {} if self.is_synchronized else _first_words()
        if members != self._buffer.members:
            self._buffer.members = LockstepConnection.members = members
            LockstepConnection.observers = observers()
            self._required.clear()
            self._told.clear()
        self._required.update(_sent_to(self._name, message))
        self._number, self._latency = message.number, message.latency.to_sec()
        rospy.rostime._set_rostime(message.header.stamp)
        for loss in self._buffer.release({**first_words, **self._required}):
            rospy.logwarn("at %.2f s: %s", message.header.stamp.to_sec(), loss)
            self.add_remark(f"{self._name}: {loss}")

    def _work(self) -> None:
        for hook in tuple(self._hooks):
            _call(hook)
        self._threads.run_turn(lambda: not self.is_synchronized or rospy.is_shutdown())
        while self._pending:
            _call(self._pending.pop(0))

    def _take_leave(self) -> None:
        """Answers for the last time, so that what has been sent takes effect and nobody waits."""
        if self.is_synchronized:
            transport.flush()
            self._answer(rospy.Time.now(), is_last=True)

    def _answer(self, stamp: rospy.Time, is_last: bool = False) -> None:
        sent = transport.sent(self._name)
        news = {channel: count for channel, count in sent.items() if self._told.get(channel) != count}
        self._told.update(news)
        remarks, self._remarks = self._remarks, set()
        period = 0.0 if is_last else min((period() for period in self._periods), default=DEFAULT_PERIOD)
        header = Header(stamp=stamp, frame_id=self._name)
        number = self._number if self.is_synchronized else 0
        told = transport.topology(), list(news), list(news.values()), sorted(remarks)
        answer = Answer(header, number, rospy.Duration(period), *told)
        with suppress(rospy.ROSException):  # rospy has closed the topic: the node is ending
            if self._answers is not None:
                self._answers.publish(answer)

    def _leave(self) -> None:
        """The simulation goes on without this node, which works out of step and asks to be back."""
        if not rospy.core.is_shutdown_requested():
            rospy.logwarn("the simulation does not wait for this node any more")
        LockstepConnection.members = frozenset()
        transport.flush()
        self._buffer.release_all()
        self._threads.notify()
        with self._working:
            self._working.notify_all()

    def _await_answer(self, number: int) -> None:
        """Until the moment of this number has been answered."""
        with self._working:
            self._working.wait_for(lambda: self._answered >= number or not self.is_synchronized, CALL_SECONDS)

    def _mind_strangers(self) -> None:
        """While no moment comes, as in a simulation that is paused, strangers are heard all the same."""
        time.sleep(STALLED_SECONDS)
        with self._working:
            if self.is_synchronized and time.monotonic() - self._answered_at > STALLED_SECONDS:
                self._buffer.release_unsynchronized()
                transport.flush()


def has_synchronized_publisher(topic: rospy.Subscriber) -> bool:
    """Whether a node that is to be in step sends on the topic: what it sends takes simulated time."""
    expected = rospy.get_param(WAIT_FOR_PARAMETER, [])
    return any(connection.callerid_pub in expected for connection in topic.impl.connections)


def observers() -> FrozenSet[str]:
    """The nodes outside that are to miss nothing."""
    return frozenset(rospy.get_param(OBSERVERS_PARAMETER, []))


def _first_words() -> Dict[Tuple[str, str], int]:
    """What a node hears before it works for the first time."""
    return {(STATIC_TOPIC, name): 1 for name in rospy.get_param(STATIC_PUBLISHERS_PARAMETER, [])}


def _sent_to(receiver: str, message: Moment) -> Dict[Tuple[str, str], int]:
    """How many messages of those that a moment tells of, by topic and sender."""
    channels = [channel.split(" ") for channel in message.channels]
    return {
        (topic, sender): count
        for (sender, to, topic), count in zip(channels, message.counts)
        if to == receiver
    }


def _call(hook: Hook) -> None:
    """A fault of one hook keeps no other from its work, as rospy has it with callbacks."""
    try:
        hook()
    except Exception:
        if not rospy.is_shutdown():
            rospy.logerr("at a moment: %s", traceback.format_exc())
