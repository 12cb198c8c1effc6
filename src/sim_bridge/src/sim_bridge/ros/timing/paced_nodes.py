"""Unsynchronised nodes, such as the official amcl and move_base, beside which time passes when they rest."""

import threading
import time
from typing import Callable, Dict, FrozenSet, List, Optional, Tuple

import rospy

from rospy_transport.connections import has_unread
from sim_bridge.rest.barrier import (
    DATA_QUIET_SECONDS,
    PATIENCE_SECONDS,
    QUIET_SECONDS,
    SETTLING_QUIET_SECONDS,
    RestBarrier,
)
from sim_bridge.rest.threads import ProcessThreads
from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.ros.timing.connection_check import ConnectionCheck

# Time between two searches for new nodes [wall s], and the name of the master, which is no node.
SEARCH_SECONDS, MASTER = 0.2, ""
# Name under which the synchronised nodes are waited for, in whose messages the others may have a part.
SYNCHRONISED = "synchronised nodes"
# Time without a new topic or service after which nodes have started [simulated s].
SETTLING_SECONDS = 2.0


class PacedNodes:
    """Holds simulated time until the nodes rest; called in the thread that owns the scene.

    Each step has two barriers, before its time is published on ``/clock`` and after: what wakes up by the
    time finds the step's data processed.

    While nodes start, all others and the master have to rest as well, for a node that waits for an answer of
    another one rests, too. A node that runs on another machine, has ended or does not rest is not waited for;
    the simulation is then not faster than real time, if it is one of those to wait for.

    Args:
        calls: Queue of the thread that owns the scene; what arrives there may not be the last.
        remark: Called with a reason why the run may not be repeatable.
        paces_all: Wait for all nodes of this machine, not only while nodes start.
        bystanders: Beginnings of the names, with slash, of nodes that are never waited for.
    """

    def __init__(
        self,
        calls: CallQueue,
        remark: Callable[[str], None],
        paces_all: bool = False,
        bystanders: Tuple[str, ...] = (),
    ):
        self._calls, self._remark = calls, remark
        self._paces_all, self._bystanders = paces_all, bystanders
        self._barrier = RestBarrier()
        self._threads: Dict[str, ProcessThreads] = {}
        self._found: Dict[str, int] = {}
        self._wanted: FrozenSet[str] = frozenset()
        self._synchronised: FrozenSet[str] = frozenset()
        self._submitted = 0
        self._reported: FrozenSet[str] = frozenset()
        self._search: Optional[threading.Thread] = None
        self._searched: FrozenSet[str] = frozenset()
        self._changes = self._seen_changes = 0
        self._settled_at = 0.0

    @property
    def names(self) -> FrozenSet[str]:
        """Nodes that are waited for, without slash."""
        waited_for = self._wanted.intersection(self._threads).difference(self._barrier.given_up)
        return frozenset(name[1:] for name in waited_for)

    def set_nodes(self, names: FrozenSet[str], synchronised: FrozenSet[str]) -> None:
        """Set the names of the nodes to wait for, and of those for which the simulation waits elsewhere."""
        self._wanted, self._synchronised = names, synchronised
        if (names or self._paces_all) and self._search is None:
            self._search = threading.Thread(target=self._find, daemon=True)
            self._search.start()

    @property
    def are_any(self) -> bool:
        """Whether there may be nodes to wait for."""
        return bool(self._wanted) or self._paces_all

    def have_rested(self, stamp: float, is_answered: bool, is_clock_sent: bool) -> bool:
        """Return whether the nodes have rested at this barrier.

        Args:
            stamp: Present simulated time [s].
            is_answered: Whether all synchronised nodes have answered; they send messages before.
            is_clock_sent: Whether this time has been published.
        """
        if not self.are_any:
            return True
        if not self._searched.issuperset({MASTER, *self._wanted}):
            return False
        self._take_found()
        submitted = self._calls.submitted
        has_news = submitted != self._submitted or has_unread()
        self._submitted = submitted
        if self._changes != self._seen_changes:
            self._seen_changes, self._settled_at = self._changes, stamp + SETTLING_SECONDS
        is_settling = stamp < self._settled_at
        chosen = self._threads.keys() & self._wanted
        if is_settling:  # also the connections of the synchronised nodes
            chosen = {*self._threads}
        elif self._paces_all:
            chosen = self._threads.keys() - self._synchronised
        nodes = {name: self._rest_of(name, self._threads[name]) for name in sorted(chosen, reverse=True)}
        nodes[SYNCHRONISED] = lambda: is_answered
        quiet = SETTLING_QUIET_SECONDS if is_settling else QUIET_SECONDS
        if not is_clock_sent:
            quiet = DATA_QUIET_SECONDS
        is_passed = self._barrier.is_passed(time.monotonic(), nodes, self._wanted, has_news, quiet)
        self._report()
        return is_passed

    def waiting_for(self) -> List[str]:
        """Return the nodes that simulated time is stopped for, without slash."""
        name = self._barrier.waiting_for()
        return [name[1:]] if name in self._wanted else []

    def reset_time(self) -> None:
        """Restart simulated time at 0."""
        self._barrier.reset()
        self._settled_at = SETTLING_SECONDS

    def _rest_of(self, name: str, threads: ProcessThreads) -> Callable[[], bool]:
        def is_resting() -> bool:
            try:
                return threads.are_resting()
            except ProcessLookupError:
                self._threads.pop(name, None)
                self._found.pop(name, None)
                threads.close()
                if name in self._wanted:
                    rospy.logwarn("%s has ended: the simulation goes on in real time", name[1:])
                return True

        return is_resting

    def _report(self) -> None:
        given_up = self._wanted.intersection(self._barrier.given_up)
        for name in sorted(given_up - self._reported):
            rospy.logwarn(
                "%s has computed for %g s without a pause: the simulation goes on in real time",
                name[1:],
                PATIENCE_SECONDS,
            )
            self._remark(f"{name} did not rest for {PATIENCE_SECONDS:g} s")
        self._reported = given_up

    def _take_found(self) -> None:
        for name, pid in list(self._found.items()):
            if name not in self._threads:
                self._threads[name] = ProcessThreads(pid)
                if name in self._wanted:
                    rospy.loginfo("simulated time waits until %s (process %d) rests", name[1:], pid)

    def _find(self) -> None:
        check, before = ConnectionCheck(), None
        while not rospy.is_shutdown():
            registrations = check.registrations()
            self._changes += registrations != before
            before = registrations
            names = {MASTER, *registrations, *self._wanted} - {rospy.get_name()}
            for name in names - self._found.keys():
                if name.startswith(self._bystanders):
                    continue
                pid = check.local_process(name)
                if pid is not None:
                    self._found[name] = pid
            self._searched = frozenset({*names, *self._searched})
            time.sleep(SEARCH_SECONDS)
