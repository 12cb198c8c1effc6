"""What synchronized nodes send: messages, counted and in one batch for each instant, and service calls."""

import threading
from collections import deque
from contextlib import suppress
from typing import (
    Any,
    Callable,
    ClassVar,
    Collection,
    Deque,
    Dict,
    FrozenSet,
    List,
    Mapping,
    Optional,
    Tuple,
)

from rospy_transport import connections
from rospy_transport.replacements import BeforeCall, ImmediateConnection

INSTANT_TOPIC, ANSWER_TOPIC, CLOCK_TOPIC = "/simulation/moment", "/simulation/answer", "/clock"
STATIC_TOPIC = "/tf_static"
# Latched: simulated time beyond which no step goes [s]; infinite for none.
HOLD_TOPIC = "/simulation/hold"
# Sent outside the batches: instants and answers carry the counts of all other messages, the clock the time.
UNCOUNTED = frozenset((INSTANT_TOPIC, ANSWER_TOPIC, CLOCK_TOPIC))
# Maximum number of messages to an observer in one batch.
MAX_BATCH = 10
INSTANT_HEADER = "moment"
# Services that change nothing in the simulation, whenever they are called. Time that is paused, or advances
# step by step, gives the same run.
READ_ONLY = frozenset(
    ("make_plan", "static_map", "dynamic_map", "set_logger_level", "tf2_frames")
    + ("pause_physics", "unpause_physics", "step")
)
READ_ONLY_PREFIX = "get_"
_local = threading.local()
# Counts by receiver and topic of connections that may have been removed since.
_last_counts: Dict[Tuple[str, str], int] = {}


class LockstepConnection(ImmediateConnection):
    """Connection that batches messages to synchronized nodes until the answer to an instant, and drops none.

    Messages to observers, and the clock, are batched as well if they are sent by ``batching_thread``, since a
    send costs as much as a message. That thread calls ``flush`` before it waits for anything.

    Attributes:
        members: Synchronized nodes; without any, the connection is a normal one.
        observers: Unsynchronized nodes that must receive all messages.
        batching_thread: Identifier of the thread that batches messages to observers.
        count: Number of messages sent.
    """

    members: ClassVar[FrozenSet[str]] = frozenset()
    observers: ClassVar[FrozenSet[str]] = frozenset()
    batching_thread: ClassVar[Optional[int]] = None
    _unsent: ClassVar[Deque["LockstepConnection"]] = deque()

    def __init__(self, connection: Any, queue_size: int):
        self.count = 0
        self._batch: List[bytes] = []
        # Reentrant, since a message may be sent while others are; the order is that of the calls.
        self._batch_lock = threading.RLock()
        super().__init__(connection, queue_size)

    def write_data(self, data: bytes) -> bool:
        is_member = self.receiver in self.members
        if is_member and self.topic == CLOCK_TOPIC:
            return True
        with self._batch_lock:
            self.count += 1
            if is_member and self.topic not in UNCOUNTED:
                return self._append(data)
            if self._may_batch() and len(self._batch) < MAX_BATCH:
                return self._append(data)
            self._send_batch()
            return super().write_data(data)

    def has_unsent(self) -> bool:
        return bool(self._batch) or super().has_unsent()

    def message_count(self) -> int:
        return self.count

    @classmethod
    def flush_all(cls) -> None:
        """Send all batched messages in order."""
        with suppress(IndexError):  # two threads may call it
            while True:
                cls._unsent.popleft().flush()

    def flush(self) -> None:
        """Send the batch; an error is raised by the next message, where rospy expects it."""
        with self._batch_lock:
            try:
                self._send_batch()
            except Exception as error:
                self.fail(error)

    def _may_batch(self) -> bool:
        if self.batching_thread is None or threading.get_ident() != self.batching_thread:
            return False
        return self.topic == CLOCK_TOPIC or (self.receiver in self.observers and self.topic not in UNCOUNTED)

    def _append(self, data: bytes) -> bool:
        if self.is_broken:
            return super().write_data(data)
        if not self._batch:
            if self.topic != CLOCK_TOPIC:
                self.keep_all()
            self._unsent.append(self)
        self._batch.append(data)
        return True

    def _send_batch(self) -> None:
        if self._batch:
            batch, self._batch = b"".join(self._batch), []
            super().write_data(batch)


def flush() -> None:
    """Send all batched messages."""
    LockstepConnection.flush_all()


def batch_sends() -> None:
    """Batch the calling thread's messages to observers from now on, until it calls ``flush``."""
    LockstepConnection.batching_thread = threading.get_ident()


def remember_counts(topic: str) -> None:
    """Remember the number of messages sent on a topic whose subscribers are about to disconnect.

    rospy removes closed connections twice a second, and so possibly before the answer to the instant.
    """
    _last_counts.update(
        ((receiver, name), connections.message_count(connection))
        for receiver, name, connection in connections.outgoing()
        if name == topic
    )


def sent(sender: str) -> Dict[str, int]:
    """Return the number of messages sent to each synchronized node, by ``sender receiver topic``."""
    members = LockstepConnection.members
    now = {
        (receiver, topic): connections.message_count(connection)
        for receiver, topic, connection in connections.outgoing()
        if receiver in members and topic not in UNCOUNTED
    }
    for channel, count in list(_last_counts.items()):
        if channel in now:
            del _last_counts[channel]
        elif channel[0] in members:
            now[channel] = count
    return {f"{sender} {receiver} {topic}": count for (receiver, topic), count in now.items()}


def topology() -> int:
    """Return a number that changes with the topics of the node."""
    return hash(connections.topic_names()) & 0xFFFFFFFF


def is_read_only(service: str) -> bool:
    """Return whether calls of a service change nothing in the simulation, by its name."""
    name = service.rsplit("/", 1)[-1]
    return name in READ_ONLY or name.startswith(READ_ONLY_PREFIX)


class CallMonitor:
    """Notes each service that a node calls which is not synchronized: the call comes at a random moment.

    Args:
        members: Returns the names of the synchronized nodes; none while nothing is synchronised.
        note: Called with a text.
        harmless: Resolved names of further services that change nothing in the simulation.

    Attributes:
        callers: Nodes that have called a service and are not synchronized; without those of ``harmless``.
    """

    def __init__(
        self,
        members: Callable[[], Collection[str]],
        note: Callable[[str], None],
        harmless: Collection[str] = (),
    ):
        self._members, self._note = members, note
        self._harmless, self._known = frozenset(harmless), set(harmless)
        self.callers: FrozenSet[str] = frozenset()

    def check(self, service: str, caller: str) -> None:
        """Note a call, the first of each service.

        Args:
            service: Resolved name of the service.
            caller: Name of the calling node.
        """
        members = self._members()
        if not members or caller in members:
            return
        if service not in self._harmless and caller not in self.callers:
            self.callers |= {caller}
        if service in self._known:
            return
        if not is_read_only(service):
            self._known.add(service)
            self._note(f"the service {service} was called by {caller}, which is not synchronized")


def call_headers(instant: int) -> Dict[str, str]:
    """Return the headers of a call at an instant; empty for 0, i.e. when the node is not synchronized."""
    return {INSTANT_HEADER: str(instant)} if instant else {}


def caller() -> str:
    """Return the synchronized node whose call this thread answers; empty if there is none."""
    return getattr(_local, "caller", "")


def delaying_calls(wait: Callable[[int], None], monitor: Optional[CallMonitor] = None) -> BeforeCall:
    """Return what ``rospy_transport.replacements.install`` calls before a service's callback.

    It delays each call of a synchronized node until ``wait(number of its instant)`` returns.

    Args:
        wait: Blocks until an instant.
        monitor: Checks the calls of other nodes.
    """

    def before_call(service: str, header: Mapping[str, str]) -> None:
        number = header.get(INSTANT_HEADER, "0")
        _local.caller = header.get("callerid", "") if number.isdigit() and int(number) else ""
        if _local.caller:
            wait(int(number))
        elif monitor is not None:
            monitor.check(service, header.get("callerid", ""))

    return before_call
