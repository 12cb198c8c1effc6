"""Unsynchronised nodes, such as the official amcl and move_base, beside which time passes when they rest."""

import threading
import time
from typing import Callable, Dict, FrozenSet, List, Optional

import rospy

from rospy_transport.connections import has_unread
from sim_bridge.process_rest import ProcessThreads
from sim_bridge.rest_barrier import PATIENCE_SECONDS, RestBarrier
from sim_bridge.ros.call_queue import CallQueue
from sim_bridge.ros.timing.connection_check import ConnectionCheck

SEARCH_SECONDS = 0.5


class PacedNodes:
    """Holds simulated time at barriers until the nodes rest; called in the thread that owns the scene.

    A node that runs on another machine, has ended or does not rest is not waited for; the simulation is then
    not faster than real time.

    Args:
        calls: Queue of the thread that owns the scene; what arrives there may not be the last.
        remark: Called with a reason why the run may not be repeatable.
    """

    def __init__(self, calls: CallQueue, remark: Callable[[str], None]):
        self._calls, self._remark = calls, remark
        self._barrier = RestBarrier()
        self._threads: Dict[str, ProcessThreads] = {}
        self._found: Dict[str, int] = {}
        self._wanted: FrozenSet[str] = frozenset()
        self._submitted = 0
        self._reported: FrozenSet[str] = frozenset()
        self._search: Optional[threading.Thread] = None

    @property
    def names(self) -> FrozenSet[str]:
        """Nodes that are waited for, without slash."""
        return frozenset(name[1:] for name in self._threads if name not in self._barrier.given_up)

    def set_nodes(self, names: FrozenSet[str]) -> None:
        """Set the names of the nodes to wait for."""
        self._wanted = names
        if names and self._search is None:
            self._search = threading.Thread(target=self._find, daemon=True)
            self._search.start()

    def may_step(self, stamp: float) -> bool:
        """Return whether the next step may be taken.

        Args:
            stamp: Present simulated time [s].
        """
        self._take_found()
        if not self._threads:
            return True
        submitted = self._calls.submitted
        has_news = submitted != self._submitted or has_unread()
        self._submitted = submitted
        nodes = {name: self._rest_of(name, threads) for name, threads in self._threads.items()}
        may_step = self._barrier.may_step(stamp, time.monotonic(), nodes, has_news)
        self._report()
        return may_step

    def waiting_for(self) -> List[str]:
        """Return the nodes that simulated time is stopped for, without slash."""
        return [name[1:] for name in self._barrier.waiting_for()]

    def reset_time(self) -> None:
        """Restart simulated time at 0."""
        self._barrier.reset()

    def _rest_of(self, name: str, threads: ProcessThreads) -> Callable[[], bool]:
        def is_resting() -> bool:
            try:
                return threads.are_resting()
            except ProcessLookupError:
                self._threads.pop(name, None)
                self._found.pop(name, None)
                threads.close()
                rospy.logwarn("%s has ended: the simulation goes on in real time", name[1:])
                return True

        return is_resting

    def _report(self) -> None:
        given_up = frozenset(self._barrier.given_up)
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
                rospy.loginfo("simulated time waits until %s (process %d) rests", name[1:], pid)

    def _find(self) -> None:
        check = ConnectionCheck()
        while not rospy.is_shutdown():
            for name in self._wanted - self._found.keys():
                pid = check.local_process(name)
                if pid is not None:
                    self._found[name] = pid
            time.sleep(SEARCH_SECONDS)
