"""Monitors whether all synchronised nodes have joined and are connected with each other."""

import math
import threading
import time
from typing import Collection, Dict, FrozenSet, List, Set

import rospy

from planar_ros.lockstep.client import observers
from sim_bridge.rest.threads import is_native
from sim_bridge.ros.timing.connection_check import ConnectionCheck

# Names of the observers to wait for, separated by spaces; a launch file knows them before they start.
EXPECTED_OBSERVERS_PARAMETER = "/simulation/expected_observers"
# Its name until version 2.0, still read.
OLD_PARAMETER = "/simulation/expected_audience"
POLL_SECONDS = 0.02
# Time limits [wall s]: for a node to start, for a node that has started to ask for lock-step, for a
# connection.
START_SECONDS, JOIN_SECONDS, CONNECT_SECONDS = 30.0, 5.0, 5.0


class ConnectionMonitor:
    """Checks, in a separate thread, that the graph is complete before simulated time passes.

    It is complete when all expected nodes have joined, each is connected to the topics of the others, of the
    simulator and of the static publishers, and the observers are connected to them. What does not come within
    its time limit is given up.

    Args:
        simulator: Name of this node.
        expected: Names of the nodes to synchronise.
        static_publishers: Names of nodes that publish static transforms.

    Attributes:
        is_complete: Whether all are there and connected, or given up.
        observers: Nodes that are not synchronised and must miss no message, as far as they are known.
        unable: Expected nodes that have started and do not support lock-step.
    """

    def __init__(self, simulator: str, expected: Collection[str], static_publishers: Collection[str]):
        self.is_complete = not expected
        self.observers: FrozenSet[str] = frozenset()
        self.unable: FrozenSet[str] = frozenset()
        self._simulator = simulator
        self._joined: Set[str] = set()
        self._absent = set(expected)
        self._expected_observers = frozenset(f"/{name}" for name in _expected_observers())
        self._static_publishers = static_publishers
        self._missing_since: Dict[str, float] = {}
        self._given_up: Set[str] = set()
        self._unreported: List[str] = []
        self._connection_check = ConnectionCheck()
        self._changed = threading.Condition()
        self._version = 1
        self._checked_version = 0 if expected else 1
        threading.Thread(target=self._run, daemon=True).start()

    def add_node(self, name: str) -> None:
        """Register that a node has asked to be synchronised."""
        with self._changed:
            self._joined.add(name)
            self._absent.discard(name)
            self.unable -= {name}
        self.recheck()

    def recheck(self) -> None:
        """Check again, as the topics of a node have changed; the graph is incomplete until then."""
        with self._changed:
            if self._joined or self._absent:
                self._version += 1
                self.is_complete = False
                self._changed.notify_all()

    def shortcomings(self) -> List[str]:
        """Return the new reasons since the last call why not all is synchronised as expected."""
        if not self._unreported:
            return []
        with self._changed:
            unreported, self._unreported = self._unreported, []
        return unreported

    def missing(self) -> List[str]:
        """Return what is missing and not given up, as texts for a log."""
        return [] if self.is_complete else sorted(set(self._missing_since) - self._given_up)

    def _run(self) -> None:
        while not rospy.is_shutdown():
            with self._changed:
                self._changed.wait_for(lambda: self._checked_version != self._version, 1.0)
                version = self._version
            if self._checked_version == version:
                continue
            missing = self._check()
            with self._changed:
                if not missing and version == self._version:
                    self._checked_version, self.is_complete = version, True
                    self._missing_since.clear()
            if missing:
                time.sleep(POLL_SECONDS)

    def _check(self) -> List[str]:
        """Return what is missing and not given up."""
        with self._changed:
            absent, members = sorted(self._absent), {self._simulator, *self._joined}
        limits: Dict[str, float] = {}
        known, able = self._connection_check.known_nodes() if absent else (set(), set())
        for name in absent:
            if name not in known or name in able:
                limits[f"the node {name}"] = START_SECONDS
            elif not self._is_unable(name):
                limits[f"the node {name} to ask for lock-step"] = START_SECONDS
        self.observers = observers()
        for name in sorted(self._expected_observers - self.observers):
            limits[f"the observer {name}"] = START_SECONDS
        if not absent:
            for gap in self._connection_check.missing(members, self.observers, self._static_publishers):
                limits[f"the connection of {gap}"] = CONNECT_SECONDS
        return [text for text, seconds in limits.items() if not self._is_given_up(text, seconds)]

    def _is_unable(self, name: str) -> bool:
        """Whether a node that has started does not support lock-step: it is native, or late to ask."""
        if name in self.unable:
            return True
        late_since = self._missing_since.get(f"the node {name} to ask for lock-step", math.inf)
        pid = self._connection_check.local_process(name)
        if time.monotonic() - late_since <= JOIN_SECONDS and not (pid and is_native(pid)):
            return False
        with self._changed:
            self.unable |= {name}
            self._unreported.append(f"{name} does not support lock-step")
        return True

    def _is_given_up(self, text: str, seconds: float) -> bool:
        now = time.monotonic()
        if text not in self._given_up and now - self._missing_since.setdefault(text, now) > seconds:
            rospy.logwarn("no sign of %s after %g s: the simulation continues without it", text, seconds)
            with self._changed:
                self._given_up.add(text)
                self._unreported.append(f"time went on without {text}")
        return text in self._given_up


def _expected_observers() -> List[str]:
    names = rospy.get_param(EXPECTED_OBSERVERS_PARAMETER, "") or rospy.get_param(OLD_PARAMETER, "")
    return str(names).split()
