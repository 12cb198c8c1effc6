"""Unsynchronised nodes, such as the official amcl and move_base, beside which time passes by rules."""

import time
from enum import Enum
from functools import partial
from typing import Callable, Collection, Dict, FrozenSet, List, Mapping, Optional, Set, Tuple

import rospy
from std_msgs.msg import String

from planar_ros.lockstep.transport import INSTANT_TOPIC
from rospy_transport.connections import drop_closed, has_undelivered, has_unprocessed, message_count, outgoing
from rospy_transport.replacements import install
from sim_bridge.rest.barrier import (
    BETWEEN_NODES_QUIET_SECONDS,
    DATA_QUIET_SECONDS,
    PATIENCE_SECONDS,
    POLLING_SECONDS,
    SETTLING_QUIET_SECONDS,
    TURNS_QUIET_SECONDS,
    AwaitedRest,
    RestBarrier,
)
from sim_bridge.rest.rules import PaceRule
from sim_bridge.rest.sent_messages import TICKS, SentCounts, SentMessages, acting_nodes, sent_counts
from sim_bridge.rest.threads import KernelThreads, ProcessThreads
from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.ros.timing.connection_monitor import CONNECT_SECONDS
from sim_bridge.ros.timing.node_search import MASTER, FoundNode, NodeSearch
from sim_bridge.ros.timing.stamped_messages import StampedMessages

# Latched: the rule of each node, one a line.
PACE_TOPIC = "/simulation/pace"
# Name under which the synchronised nodes are waited for, in whose messages the others may have a part.
SYNCHRONISED = "synchronised nodes"
# The same for messages that have not arrived yet.
MESSAGES = "messages"
# Time without a new topic or service after which nodes have started [simulated s].
SETTLING_SECONDS = 2.0
# Time between two checks of all connections meanwhile, unless the graph has changed [simulated s].
CHECK_SECONDS = 0.1


class Before(Enum):
    """What follows a barrier: readings whose transforms were sent, the clock, a tick, or the next step.

    Before readings the nodes must rest even if no other one receives their messages, and before a tick the
    synchronised nodes, which receive the messages of the others, must rest, too.
    """

    SENSORS = 1
    CLOCK = 2
    TICK = 3
    STEP = 4


class _NewConnections:
    """Whether nodes that start have connected: they do so in threads that rest in between.

    Args:
        search: Finds missing connections.
        remark: Called with a reason why the run may not be repeatable.
    """

    def __init__(self, search: NodeSearch, remark: Callable[[str], None]):
        self._search, self._remark = search, remark
        self._awaited_search, self._since = 0, 0.0
        self._unconnectable: Set[str] = set()
        self._is_one_lost, self._check_at = False, 0.0

    def check_again(self) -> None:
        """Have a search begin at the next barrier."""
        self._awaited_search, self._is_one_lost = 0, False

    def note_lost(self) -> None:
        """Have a search begin now: a receiver has closed a connection, and may subscribe again."""
        self._awaited_search, self._is_one_lost = 0, True
        self._search.check_all_connections()

    def are_missing(self, stamp: float, is_due: bool, is_graph_new: bool) -> bool:
        """Return whether to wait for connections.

        Args:
            stamp: Present simulated time [s].
            is_due: Whether nodes start, and this barrier is one at which their connections are checked.
            is_graph_new: Whether the graph has changed since the last barrier.
        """
        is_recent = 0.0 < self._check_at - stamp <= CHECK_SECONDS
        if not (is_due and (is_graph_new or not is_recent) or self._is_one_lost):
            return False
        if not self._are_made():
            return True
        self._check_at = stamp + CHECK_SECONDS - 1e-6
        return False

    def _are_made(self) -> bool:
        """Return whether a search that has begun at this barrier found all connections made."""
        wall = time.monotonic()
        if not self._awaited_search:
            self._awaited_search, self._since = self._search.request(), wall
        if self._search.finished < self._awaited_search:
            return False
        missing = [text for text in self._search.unconnected if text not in self._unconnectable]
        if missing and wall - self._since <= CONNECT_SECONDS:
            self._awaited_search = self._search.request()
            return False
        for text in missing:
            self._unconnectable.add(text)
            self._remark(f"{text} was not made within {CONNECT_SECONDS:g} s")
        return True


class _StatedRules:
    """Logs and publishes the rules of the nodes."""

    def __init__(self) -> None:
        self._sentences: Dict[str, str] = {}
        self._topic = rospy.Publisher(PACE_TOPIC, String, queue_size=1, latch=True)

    def state(self, name: str, sentence: str) -> bool:
        """State the rule of a node, unless it was; return whether it is new."""
        if self._sentences.get(name) == sentence:
            return False
        self._sentences[name] = sentence
        rospy.loginfo("%s", sentence)
        self._topic.publish("\n".join(self._sentences[each] for each in sorted(self._sentences)))
        return True


class PacedNodes:
    """Holds simulated time by the rules of the nodes; called in the thread that owns the scene.

    Each step has two barriers, before its time is published on ``/clock`` and after: what wakes up by the
    time finds the step's data processed.

    While nodes start, all others and the master have to rest as well, for a node that waits for an answer of
    another one rests, too. A node that runs on another machine, has ended or does not rest is not waited for;
    the simulation is then not faster than real time, if it is one of those to wait for, or takes part.

    Args:
        calls: Queue of the thread that owns the scene; what arrives there may not be the last.
        remark: Called with a reason why the run may not be repeatable.
        rules: Rules by the name of the node; such nodes are always waited for.
        search: Finds the nodes and their rules.
        messages: Receives the messages of nodes that are paced by their stamps.
        paces_all: Wait for all nodes of this machine, not only while nodes start.
    """

    def __init__(
        self,
        calls: CallQueue,
        remark: Callable[[str], None],
        rules: Mapping[str, PaceRule],
        search: NodeSearch,
        messages: StampedMessages,
        paces_all: bool = False,
    ):
        self._calls, self._remark, self._search, self._messages = calls, remark, search, messages
        self._paces_all, self._named = paces_all, frozenset(rules)
        self._barrier, self._kernel = RestBarrier(), KernelThreads()
        self._threads: Dict[str, ProcessThreads] = {}
        self._ended: Dict[str, int] = {}
        self._nodes: Dict[str, FoundNode] = {}
        self._taken: Tuple[object, ...] = (None,)
        nobody: FrozenSet[str] = frozenset()
        self._wanted = self._synchronised = self._callers = self._reported = nobody
        self._rules = _StatedRules()
        self._submitted = self._seen_changes = 0
        self._connections, self._sent = _NewConnections(search, remark), SentMessages()
        self._settled_at, self._is_graph_new, self._is_answered = 0.0, False, False
        self._wait: Optional[AwaitedRest] = None

    @property
    def names(self) -> FrozenSet[str]:
        """Nodes that do not hold the simulation at real time, without slash."""
        waited_for = self._wanted.intersection(self._threads).difference(self._barrier.given_up)
        kinds = {name: self._nodes[name].rule.kind for name in self._wanted.intersection(self._nodes)}
        return frozenset(
            name[1:]
            for name, kind in kinds.items()
            if kind == "observe" or kind == "rest" and name in waited_for
        )

    @property
    def limiting(self) -> FrozenSet[str]:
        """Nodes beside which time passes in real time at most, without slash."""
        if not self.are_any:
            return frozenset()
        slow = {
            name
            for name, node in self._nodes.items()
            if node.rule.kind == "real_time" and node.is_known or name in self._barrier.given_up
        }
        slow.intersection_update(self._awaited())
        return frozenset(name[1:] for name in slow.union(self._wanted.intersection(self._ended)))

    def set_nodes(self, names: FrozenSet[str], synchronised: FrozenSet[str], callers: FrozenSet[str]) -> None:
        """Set the nodes to wait for, those waited for elsewhere, and callers of the simulator's services."""
        self._wanted, self._synchronised = names | (self._named - synchronised), synchronised
        self._callers = callers
        if self.are_any and self._search.start():
            install(notes_receipt=True)

    @property
    def are_any(self) -> bool:
        """Whether there may be nodes to wait for."""
        return bool(self._wanted) or self._paces_all

    def may_await(self, names: Set[str]) -> bool:
        """Return whether one of some nodes is waited for, or not known yet."""
        return self.are_any and not names.isdisjoint(self._chosen(False) | names - self._search.searched)

    def have_rested(self, before: Before, stamp: float, is_answered: bool, is_clock_sent: bool) -> bool:
        """Return whether the nodes have rested at this barrier.

        Args:
            before: What follows the barrier.
            stamp: Present simulated time [s].
            is_answered: Whether all synchronised nodes have answered; they send messages before.
            is_clock_sent: Whether this time has been published.
        """
        if not self.are_any:
            return True
        if not self._search.searched.issuperset({MASTER, *(self._wanted - self._named)}):
            return False
        self._take_found()
        is_receiving = has_unprocessed()
        submitted = self._calls.submitted  # afterwards: what has been processed has submitted its calls
        has_news = is_receiving or submitted != self._submitted
        self._submitted = submitted
        if self._search.changes != self._seen_changes:
            self._seen_changes, self._settled_at = self._search.changes, stamp + SETTLING_SECONDS
            self._is_graph_new = True
        if drop_closed():
            self._settled_at, self._is_graph_new = stamp + SETTLING_SECONDS, True
            self._connections.note_lost()
        is_settling = stamp < self._settled_at
        is_check_due = is_settling and before is Before.CLOCK
        if self._connections.are_missing(stamp, is_check_due, self._is_graph_new):
            return False
        if not self._barrier.is_begun and not self._must_wait(before, has_news, is_settling, is_clock_sent):
            return True
        self._is_answered = is_answered
        if self._wait is None:
            chosen = self._chosen(is_settling or before is Before.TICK)
            self._wait = self._wait_for(chosen, before, is_clock_sent)
        is_passed = self._barrier.is_passed(time.monotonic(), self._wait, has_news)
        self._report()
        if is_passed:
            self._connections.check_again()
            self._is_graph_new = False
            self._sent.note_rest()
        return is_passed

    def _wait_for(self, chosen: Set[str], before: Before, is_clock_sent: bool) -> AwaitedRest:
        for name in chosen:
            self._threads[name].begin_barrier()
        quiet = _quiet(chosen, self._nodes, self._threads, before, is_clock_sent)
        if self._is_graph_new:
            quiet = SETTLING_QUIET_SECONDS, False
        # First what is quickly known.
        nodes: Dict[str, Callable[[], bool]] = {SYNCHRONISED: lambda: self._is_answered}
        for name in sorted(chosen, reverse=True):
            nodes[name] = partial(self._is_resting, name, self._threads[name])
        nodes[MESSAGES] = lambda: self._kernel.are_resting() and not has_undelivered(chosen)
        awaited = self._awaited() | {SYNCHRONISED, MESSAGES}
        timed = _timed(chosen, self._nodes, self._threads) if quiet[1] else []
        return AwaitedRest(nodes, awaited, *quiet, lambda: all(each.have_polled() for each in timed))

    @property
    def pause(self) -> float:
        """Time until the nodes are looked at again [wall s]."""
        return self._barrier.pause(time.monotonic())

    def waiting_for(self) -> List[str]:
        """Return the nodes that simulated time is stopped for, without slash."""
        name = self._barrier.waiting_for()
        return [name[1:]] if name in self._wanted else []

    def reset_time(self) -> None:
        """Restart simulated time at 0."""
        self._barrier.reset()
        self._settled_at = SETTLING_SECONDS

    def _chosen(self, with_synchronised: bool) -> Set[str]:
        """Return the nodes that have to rest."""
        kinds = {name: self._nodes[name].rule.kind for name in self._threads if name in self._nodes}
        if with_synchronised:
            return {name for name, kind in kinds.items() if kind != "observe"}
        return {name for name, kind in kinds.items() if kind == "rest" and self._is_paced(name)}

    def _must_wait(self, before: Before, has_news: bool, is_settling: bool, is_clock_sent: bool) -> bool:
        """Return whether a node may have something to do that matters now."""
        sent, chosen, is_clock_next = _sent(self._nodes), self._chosen(False), before is Before.CLOCK
        if not (is_settling or before in (Before.SENSORS, Before.TICK) or self._sent.acting and has_news):
            with_all = is_clock_next or is_clock_sent and _may_wait(chosen, self._nodes, self._threads)
            if not self._sent.wake_any(sent, chosen, is_clock_next, with_all):
                if is_clock_sent:
                    self._sent.note_idle(sent)
                return False
        self._sent.await_rest(sent)
        self._wait = None
        return True

    def _is_paced(self, name: str) -> bool:
        return name in self._wanted or self._paces_all and name not in self._synchronised

    def _awaited(self) -> FrozenSet[str]:
        """Return the nodes for which the simulation has full patience."""
        parts = (name for name, node in self._nodes.items() if node.receivers and self._is_paced(name))
        return self._wanted.union(parts)

    def _is_resting(self, name: str, threads: ProcessThreads) -> bool:
        try:
            return threads.are_resting()
        except ProcessLookupError:
            self._drop(name)
            return True

    def _drop(self, name: str) -> None:
        """Wait no longer for a node that has ended."""
        self._wait = None
        threads = self._threads.pop(name, None)
        if threads is not None:
            self._ended[name] = threads.pid
            threads.close()
            if name in self._wanted:
                rospy.logwarn("%s has ended: the simulation goes on in real time", name[1:])

    def _report(self) -> None:
        given_up = self._awaited().intersection(self._barrier.given_up)
        text = "%s has computed for %g s without a pause: the simulation goes on in real time"
        for name in sorted(given_up - self._reported):
            rospy.logwarn(text, name[1:], PATIENCE_SECONDS)
            self._remark(f"{name} did not rest for {PATIENCE_SECONDS:g} s")
        for name in sorted(self._reported - given_up):
            if name in self._threads:
                rospy.loginfo("%s rests again: simulated time waits for it", name[1:])
        self._reported = given_up

    def _take_found(self) -> None:
        """Take over what the search has found, unless it is what was taken last."""
        found = (self._search.nodes, self._wanted, self._synchronised, self._callers)
        if found[0] is self._taken[0] and found[1:] == self._taken[1:]:
            return
        self._taken, self._wait = found, None
        self._nodes = found[0]
        receivers = {name: node.receivers for name, node in found[0].items()}
        self._sent.acting = acting_nodes(receivers, {rospy.get_name(), *self._callers}, self._synchronised)
        for name in self._threads.keys() - self._nodes.keys():
            self._drop(name)
        for name, node in self._nodes.items():
            threads, pid = self._threads.get(name), node.pid
            is_new = threads is None or threads.pid != pid
            if pid is not None and pid != self._ended.get(name) and is_new:
                self._threads[name] = ProcessThreads(pid)
                self._ended.pop(name, None)
            if name != MASTER and self._is_paced(name) and node.is_known:
                self._state_rule(name, node)

    def _state_rule(self, name: str, node: FoundNode) -> None:
        """Log, publish and apply the rule of a node, once."""
        if not self._rules.state(name, sentence := node.rule.sentence(name[1:])):
            return
        if name in self._wanted:
            self._remark(sentence)
        if node.rule.kind == "stamps":
            self._messages.follow(name[1:], node.rule.topic)


def _sent(nodes: Mapping[str, FoundNode]) -> SentCounts:
    """Return the numbers of messages sent to each node, and of ticks."""
    rows = (
        (TICKS if topic == INSTANT_TOPIC else receiver, topic, message_count(connection))
        for receiver, topic, connection in outgoing()
    )
    return sent_counts(rows, {name: node.rule.keeps for name, node in nodes.items()})


def _quiet(
    chosen: Set[str],
    nodes: Mapping[str, FoundNode],
    threads: Mapping[str, ProcessThreads],
    before: Before,
    is_clock_sent: bool,
) -> Tuple[float, bool]:
    """Return for how long chosen nodes must rest [wall s], and whether from a look at which they do."""
    if is_clock_sent and before is not Before.CLOCK:
        may_poll = _may_poll(_timed(chosen, nodes, threads))
        if any(threads[name].take_turns for name in chosen):
            return TURNS_QUIET_SECONDS, False
        if may_poll:
            return POLLING_SECONDS, True
    if before is Before.TICK or before is Before.CLOCK and _are_sending(chosen, nodes):
        return BETWEEN_NODES_QUIET_SECONDS, False
    return DATA_QUIET_SECONDS, False


def _timed(
    chosen: Collection[str], nodes: Mapping[str, FoundNode], threads: Mapping[str, ProcessThreads]
) -> List[ProcessThreads]:
    """Return the threads of chosen nodes with timers or loops that matter."""
    return [threads[name] for name in chosen if name not in nodes or nodes[name].rule.timers]


def _may_poll(timed: List[ProcessThreads]) -> bool:
    """Whether loops or timers look at the clock; all are asked, so that they are learned."""
    return sum(each.may_poll() for each in timed) > 0


def _may_wait(
    chosen: Collection[str], nodes: Mapping[str, FoundNode], threads: Mapping[str, ProcessThreads]
) -> bool:
    """Whether a thread of chosen nodes may wait for a time, as those of Python always may."""
    timed = _timed(chosen, nodes, threads)
    return _may_poll(timed) or not all(each.is_native for each in timed)


def _are_sending(chosen: Set[str], nodes: Mapping[str, FoundNode]) -> bool:
    """Whether some of the chosen nodes receive messages of others of them."""
    return any(nodes[name].receivers & chosen for name in chosen & nodes.keys())
