"""Watches, in a thread of its own, whether the loop of the nodes in step is closed."""

import threading
import time
from typing import Collection, Dict, FrozenSet, List, Set

import rospy

from planar_ros.step.closure import ConnectionCheck
from planar_ros.step.step import observers

# Names of nodes, by spaces: those of the audience that will come. The launch file knows them before they do.
EXPECTED_AUDIENCE_PARAMETER = "/simulation/expected_audience"
POLL_SECONDS = 0.02
# Wall seconds: for nodes to come, for one that is there to show that it can be in step, for connections.
COMING_SECONDS, STRANGE_SECONDS, CONNECTING_SECONDS = 30.0, 5.0, 5.0


class LoopWatch:
    """The loop is closed when all ``expected`` nodes have joined and hear each other and the node ``me``.

    They are connected to the ``static_publishers`` by then too, and who is to look on does.
    What does not come within its time is given up. ``audience``: who looks on, as far as it is known.
    """

    def __init__(self, me: str, expected: Collection[str], static_publishers: Collection[str]):
        self.is_closed = not expected
        self.audience: FrozenSet[str] = frozenset()
        self._me = me
        self._joined: Set[str] = set()
        self._absent = set(expected)
        self._onlookers = frozenset(f"/{name}" for name in _expected_audience())
        self._static_publishers = static_publishers
        self._since: Dict[str, float] = {}
        self._given_up: Set[str] = set()
        self._untold: List[str] = []
        self._closure = ConnectionCheck()
        self._changed = threading.Condition()
        self._version = 1
        self._seen = 0 if expected else 1
        threading.Thread(target=self._watch, daemon=True).start()

    def join(self, name: str) -> None:
        """A node is there and asks to be in step."""
        with self._changed:
            self._joined.add(name)
            self._absent.discard(name)
        self.look_again()

    def look_again(self) -> None:
        """Somebody has other topics: the loop is open until all is connected."""
        with self._changed:
            if self._joined or self._absent:
                self._version += 1
                self.is_closed = False
                self._changed.notify_all()

    def given_up(self) -> List[str]:
        """What has been given up since the last call, for people."""
        with self._changed:
            untold, self._untold = self._untold, []
        return untold

    def gaps(self) -> List[str]:
        """What the loop is open for, for people."""
        return [] if self.is_closed else sorted(set(self._since) - self._given_up)

    def _watch(self) -> None:
        while not rospy.is_shutdown():
            with self._changed:
                self._changed.wait_for(lambda: self._seen != self._version, 1.0)
                version = self._version
            if self._seen == version:
                continue
            gaps = self._missing()
            with self._changed:
                if not gaps and version == self._version:
                    self._seen, self.is_closed = version, True
                    self._since.clear()
            if gaps:
                time.sleep(POLL_SECONDS)

    def _missing(self) -> List[str]:
        """What is missing and not given up; those given up are remembered."""
        with self._changed:
            absent, members = sorted(self._absent), {self._me, *self._joined}
        gaps = {}
        known, able = self._closure.known() if absent else (set(), set())
        for name in absent:
            if name in known and name not in able:
                gaps[f"the node {name}, which is not one of ours"] = STRANGE_SECONDS
            else:
                gaps[f"the node {name}"] = COMING_SECONDS
        self.audience = observers()
        for name in sorted(self._onlookers - self.audience):
            gaps[f"the node {name}, which is to look on"] = COMING_SECONDS
        if not absent:
            for gap in self._closure.gaps(members, self.audience, self._static_publishers):
                gaps[f"the connection of {gap}"] = CONNECTING_SECONDS
        return [gap for gap, seconds in gaps.items() if not self._is_given_up(gap, seconds)]

    def _is_given_up(self, gap: str, seconds: float) -> bool:
        now = time.monotonic()
        if gap not in self._given_up and now - self._since.setdefault(gap, now) > seconds:
            rospy.logwarn("waited %g s in vain for %s: the simulation goes on without", seconds, gap)
            with self._changed:
                self._given_up.add(gap)
                self._untold.append(gap)
        return gap in self._given_up


def _expected_audience() -> List[str]:
    return rospy.get_param(EXPECTED_AUDIENCE_PARAMETER, "").split()
