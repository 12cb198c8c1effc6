"""Problems of a ROS graph, derived from a snapshot of it. No ROS."""

from dataclasses import asdict, dataclass, field
from typing import Any, Dict, List, Mapping, Optional, Sequence, Set

# Topics without which their subscribers cannot work; others, such as goals, are published on demand.
ESSENTIAL_TOPICS = ("/scan", "/odom", "/map")


@dataclass
class NodeState:
    """A node.

    Attributes:
        name: Resolved name.
        is_alive: It answers XML-RPC calls.
        waits_for: What it publishes on ``~waiting_for``.
    """

    name: str
    is_alive: bool = True
    waits_for: List[str] = field(default_factory=list)


@dataclass
class TopicState:
    """A topic.

    Attributes:
        name: Resolved name.
        publishers: Publishing nodes.
        subscribers: Subscribing nodes.
        rate: Messages per simulated second; None if not measured.
    """

    name: str
    publishers: List[str] = field(default_factory=list)
    subscribers: List[str] = field(default_factory=list)
    rate: Optional[float] = None


@dataclass
class GraphSnapshot:
    """State of a ROS graph.

    Attributes:
        master: URI of the master; None if none is running.
        other_masters: URIs of further masters on this machine.
        nodes: All nodes.
        topics: All topics.
        parents: All parents published for each frame.
        uses_simulated_time: ``/use_sim_time`` is true.
        real_time_factor: Simulated per wall-clock second; None without a clock.
        versions: Software versions.
    """

    master: Optional[str] = None
    other_masters: List[str] = field(default_factory=list)
    nodes: List[NodeState] = field(default_factory=list)
    topics: List[TopicState] = field(default_factory=list)
    parents: Dict[str, Set[str]] = field(default_factory=dict)
    uses_simulated_time: bool = False
    real_time_factor: Optional[float] = None
    versions: Dict[str, str] = field(default_factory=dict)

    def topic(self, name: str) -> Optional[TopicState]:
        """Return a topic by its name."""
        return next((topic for topic in self.topics if topic.name == name), None)


def problems(snapshot: GraphSnapshot) -> List[str]:
    """Return what keeps the graph from working, causes before consequences."""
    if snapshot.master is None:
        return []
    return [
        *_clock_problems(snapshot),
        *_node_problems(snapshot),
        *_topic_problems(snapshot),
        *_frame_problems(snapshot),
    ]


def frame_chain(parents: Mapping[str, Set[str]], frame: str) -> List[str]:
    """Return the frames from the root of the tree to ``frame``."""
    found = [frame]
    while found[0] in parents and len(found) <= len(parents):
        found.insert(0, min(parents[found[0]]))
    return found


def frame_branches(parents: Mapping[str, Set[str]]) -> List[str]:
    """Return a line for each chain of frames; leaves with the same parent share a line."""
    inner = {parent for several in parents.values() for parent in several}
    leaves: Dict[str, List[str]] = {}
    for frame in sorted(set(parents) - inner):
        leaves.setdefault(" -> ".join(frame_chain(parents, frame)[:-1]), []).append(frame)
    return [f"{trunk} -> {', '.join(frames)}" for trunk, frames in leaves.items()]


def as_json(snapshot: GraphSnapshot) -> Dict[str, Any]:
    """Return the snapshot and its problems for programs."""
    content = asdict(snapshot)
    content["parents"] = {frame: sorted(parents) for frame, parents in sorted(snapshot.parents.items())}
    return {
        "healthy": snapshot.master is not None and not problems(snapshot),
        **content,
        "problems": problems(snapshot),
    }


def as_text(snapshot: GraphSnapshot) -> List[str]:
    """Return the snapshot and its problems for people, line by line."""
    lines = [f"versions  {', '.join(f'{name} {version}' for name, version in snapshot.versions.items())}"]
    if snapshot.master is None:
        return [*lines, "master    none: nothing is running"]
    lines.append(f"master    {snapshot.master}" + _others(snapshot.other_masters))
    lines.append(f"clock     {_clock(snapshot)}")
    lines += _column("nodes", [_node_line(node) for node in snapshot.nodes])
    lines += _column("topics", [_topic_line(topic) for topic in snapshot.topics if topic.rate is not None])
    lines += _column("frames", frame_branches(snapshot.parents))
    return lines + _column("problems", problems(snapshot) or ["none"])


def _clock_problems(snapshot: GraphSnapshot) -> List[str]:
    clock = snapshot.topic("/clock")
    has_clock = clock is not None and bool(clock.publishers)
    if snapshot.uses_simulated_time and not has_clock:
        return ["use_sim_time is true, but nobody publishes /clock: every node waits for the time"]
    if has_clock and not snapshot.uses_simulated_time:
        return ["/clock is published, but use_sim_time is not true: the nodes use the wall clock"]
    if has_clock and snapshot.real_time_factor == 0.0:
        return ["/clock stands still: the simulation is paused, or waits for a node"]
    return []


def _node_problems(snapshot: GraphSnapshot) -> List[str]:
    dead = [f"{node.name} is registered but does not answer" for node in snapshot.nodes if not node.is_alive]
    waiting = [f"{node.name} waits for {what}" for node in snapshot.nodes for what in node.waits_for]
    return dead + waiting


def _topic_problems(snapshot: GraphSnapshot) -> List[str]:
    found = []
    for topic in snapshot.topics:
        if (
            topic.name in ESSENTIAL_TOPICS
            and topic.subscribers
            and not topic.publishers
            and topic.name != "/clock"
        ):
            found.append(
                f"no node publishes {topic.name}, to which {', '.join(topic.subscribers)} subscribes"
            )
        elif topic.rate == 0.0 and topic.publishers and snapshot.real_time_factor != 0.0:
            found.append(f"no messages on {topic.name} from {', '.join(topic.publishers)}")
    return found


def _frame_problems(snapshot: GraphSnapshot) -> List[str]:
    found = [
        f"frame {frame} has several parents: {', '.join(sorted(parents))}"
        for frame, parents in sorted(snapshot.parents.items())
        if len(parents) > 1
    ]
    roots = {parent for several in snapshot.parents.values() for parent in several} - set(snapshot.parents)
    if len(roots) > 1:
        found.append(f"the frames form {len(roots)} trees, with the roots {', '.join(sorted(roots))}")
    return found


def _others(masters: Sequence[str]) -> str:
    return f" (others: {', '.join(masters)}; choose with --master)" if masters else ""


def _clock(snapshot: GraphSnapshot) -> str:
    if not snapshot.uses_simulated_time:
        return "wall clock (use_sim_time is not true)"
    if snapshot.real_time_factor is None:
        return "simulated, but no node publishes it"
    return f"simulated, {snapshot.real_time_factor:.2f} x real time"


def _node_line(node: NodeState) -> str:
    if not node.is_alive:
        return f"{node.name}: does not answer"
    return f"{node.name}: {'waits for ' + '; '.join(node.waits_for) if node.waits_for else 'ok'}"


def _topic_line(topic: TopicState) -> str:
    return f"{topic.name}: {topic.rate:.1f} Hz from {', '.join(topic.publishers) or 'no node'}"


def _column(title: str, entries: Sequence[str]) -> List[str]:
    return [f"{title if not number else '':<9} {entry}" for number, entry in enumerate(entries or ["none"])]
