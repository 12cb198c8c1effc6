"""Search of the graph for the other nodes: their processes, and the rules by which they are paced."""

import threading
import time
from itertools import chain
from pathlib import Path
from typing import Dict, FrozenSet, Mapping, NamedTuple, Optional, Set, Tuple

import rospy

from sim_bridge.rest.rules import NodeFacts, PaceRule, choose_rule, program_of
from sim_bridge.rest.threads import PROC, has_ended
from sim_bridge.ros.timing.connection_check import ConnectionCheck, NodesByName

# Time between two searches [wall s], and the name of the master, which is no node.
SEARCH_SECONDS, MASTER = 0.2, ""
# Time in which a node that has appeared subscribes to the clock [wall s].
START_SECONDS = 2.0
LOG_TOPICS = frozenset({"/rosout", "/rosout_agg"})
Tables = Tuple[NodesByName, NodesByName, NodesByName]


class FoundNode(NamedTuple):
    """A node of the graph.

    Attributes:
        pid: Its process; None on another machine.
        rule: Rule by which it is paced.
        is_known: Whether it has had the time to subscribe to the clock, so that its rule is final.
        receivers: Other nodes, the simulator among them, that subscribe to one of its topics; no observers.
    """

    pid: Optional[int]
    rule: PaceRule
    is_known: bool
    receivers: FrozenSet[str] = frozenset()


class NodeSearch:
    """Searches the graph in a separate thread.

    Args:
        named: Rules by the name of the node.
        known: Rules by the name of the program.
        bystanders: Beginnings of the names, with slash, of nodes that are not searched for.

    Attributes:
        nodes: The nodes found, by name.
        searched: Names that have been searched for.
        changes: Number of searches that found topics or services of nodes that were not there before.
        finished: Number of searches that have finished.
        unconnected: Connections that the latest search found missing, as texts; asked for by ``request``.
    """

    def __init__(
        self, named: Mapping[str, PaceRule], known: Mapping[str, PaceRule], bystanders: Tuple[str, ...]
    ):
        self.nodes: Dict[str, FoundNode] = {}
        self.searched: FrozenSet[str] = frozenset()
        self.changes = self.finished = 0
        self.unconnected: Tuple[str, ...] = ()
        self._begun, self._is_requested = 0, threading.Event()
        self._connected_graph: Optional[Tables] = None
        self._must_check_all = False
        self._named, self._known, self._bystanders = named, known, bystanders
        self._check = ConnectionCheck()
        self._processes: Dict[str, Tuple[Optional[int], str]] = {}
        self._appeared: Dict[str, float] = {}
        self._thread: Optional[threading.Thread] = None

    def start(self) -> bool:
        """Search from now on; return whether it has not been searched before."""
        is_first = self._thread is None
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, daemon=True)
            self._thread.start()
        return is_first

    def request(self) -> int:
        """Search at once, for missing connections, too; return the number that ``finished`` reaches then."""
        self._is_requested.set()
        return self._begun + 1

    def check_all_connections(self) -> None:
        """Have the next ``request`` look for missing connections also if the graph is as before."""
        self._must_check_all = True

    def _run(self) -> None:
        before: Optional[Tables] = None
        while not rospy.is_shutdown():
            self._begun += 1
            with_connections = self._is_requested.is_set()
            self._is_requested.clear()
            graph = self._check.graph()
            self.changes += before is None or has_more(graph, before)
            before = graph
            names = {MASTER, *chain(*(chain(*table.values()) for table in graph))} - {rospy.get_name()}
            self._find_processes({name for name in names if not name.startswith(self._bystanders)})
            self.nodes = self._with_rules(graph)
            self.searched = frozenset({*names, *self.searched})
            if with_connections:
                self.unconnected = self._missing_connections(graph)
            self.finished = self._begun
            self._is_requested.wait(SEARCH_SECONDS)

    def _missing_connections(self, graph: Tables) -> Tuple[str, ...]:
        """Return the connections that nodes of this machine still have to make; skips an unchanged graph."""
        if graph == self._connected_graph and not self._must_check_all:
            return ()
        self._must_check_all = False
        nodes = {name for name, node in self.nodes.items() if node.pid and node.rule.kind != "observe"}
        missing = tuple(self._check.missing({*nodes, rospy.get_name()} - {MASTER}, (), ()))
        self._connected_graph = None if missing else graph
        return missing

    def _find_processes(self, names: Set[str]) -> None:
        for name in names - self._processes.keys():
            pid = self._check.local_process(name)
            if pid is not None:
                self._processes[name] = (pid, _program(pid))
            elif name and self._check.is_elsewhere(name):
                self._processes[name] = (None, "")
            self._appeared.setdefault(name, time.monotonic())
        for name, (pid, _) in list(self._processes.items()):
            if name not in names or pid is not None and has_ended(pid):
                self._processes.pop(name, None)
                self._appeared.pop(name, None)

    def _with_rules(self, graph: Tables) -> Dict[str, FoundNode]:
        published, subscribed, _ = graph
        on_clock, now = frozenset(subscribed.get("/clock", ())), time.monotonic()
        found: Dict[str, FoundNode] = {}
        for name, (pid, program) in list(self._processes.items()):
            is_known = name in on_clock or now - self._appeared.get(name, now) > START_SECONDS
            facts = NodeFacts(name, program, name == MASTER or name in on_clock or not is_known)
            rule = choose_rule(facts, self._named, self._known)
            found[name] = FoundNode(pid, rule, is_known)
        others = {name for name, node in found.items() if node.rule.kind != "observe"} | {rospy.get_name()}
        receivers: Dict[str, Set[str]] = {}
        for topic in published.keys() - LOG_TOPICS:
            for name in found.keys() & set(published[topic]):
                subscribers = others.intersection(subscribed.get(topic, ())) - {name}
                receivers.setdefault(name, set()).update(subscribers)
        for name, names in receivers.items():
            found[name] = found[name]._replace(receivers=frozenset(names))
        return found


def has_more(graph: Tables, before: Tables) -> bool:
    """Whether a graph has an entry that it had not before; a node that has gone connects to nothing."""
    return any(
        set(nodes).difference(earlier.get(name, ()))
        for table, earlier in zip(graph, before)
        for name, nodes in table.items()
    )


def _program(pid: int, proc: Path = PROC) -> str:
    try:
        words = (proc / str(pid) / "cmdline").read_bytes().decode(errors="replace").split("\0")
    except OSError:
        words = []
    return program_of(word for word in words if word) or "unknown"
