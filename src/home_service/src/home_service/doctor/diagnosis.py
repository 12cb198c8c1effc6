"""What is wrong with a ROS graph, told from what was found of it. No ROS."""

from dataclasses import asdict, dataclass, field
from typing import Any, Dict, List, Mapping, Optional, Sequence, Set

# Without these a node that listens to them cannot work; others, such as goals, come when somebody wants to.
ESSENTIAL_TOPICS = ("/scan", "/odom", "/map")


@dataclass
class Node:
    """A node by what the master and itself say. ``waits_for``: in its own words."""

    name: str
    is_alive: bool = True
    waits_for: List[str] = field(default_factory=list)


@dataclass
class Topic:
    """Who sends and hears a topic; ``rate``: messages per simulated second, None if that was not measured."""

    name: str
    publishers: List[str] = field(default_factory=list)
    subscribers: List[str] = field(default_factory=list)
    rate: Optional[float] = None


@dataclass
class Findings:
    """Everything that was found. ``parents``: of each frame, all that were told for it."""

    master: Optional[str] = None
    other_masters: List[str] = field(default_factory=list)
    nodes: List[Node] = field(default_factory=list)
    topics: List[Topic] = field(default_factory=list)
    parents: Dict[str, Set[str]] = field(default_factory=dict)
    uses_simulated_time: bool = False
    real_time_factor: Optional[float] = None
    versions: Dict[str, str] = field(default_factory=dict)

    def topic(self, name: str) -> Optional[Topic]:
        return next((topic for topic in self.topics if topic.name == name), None)


def problems(findings: Findings) -> List[str]:
    """What keeps the graph from working, the causes before what follows from them."""
    if findings.master is None:
        return []
    return [
        *_clock_problems(findings),
        *_node_problems(findings),
        *_topic_problems(findings),
        *_frame_problems(findings),
    ]


def chain(parents: Mapping[str, Set[str]], frame: str) -> List[str]:
    """The frames from the root of the tree to ``frame``, as far as each has a parent."""
    found = [frame]
    while found[0] in parents and len(found) <= len(parents):
        found.insert(0, min(parents[found[0]]))
    return found


def branches(parents: Mapping[str, Set[str]]) -> List[str]:
    """One line for each frame that ends a chain, or for all that hang on the same one."""
    inner = {parent for several in parents.values() for parent in several}
    leaves: Dict[str, List[str]] = {}
    for frame in sorted(set(parents) - inner):
        leaves.setdefault(" -> ".join(chain(parents, frame)[:-1]), []).append(frame)
    return [f"{trunk} -> {', '.join(frames)}" for trunk, frames in leaves.items()]


def as_json(findings: Findings) -> Dict[str, Any]:
    """The findings and the problems, for programs."""
    content = asdict(findings)
    content["parents"] = {frame: sorted(parents) for frame, parents in sorted(findings.parents.items())}
    return {
        "healthy": findings.master is not None and not problems(findings),
        **content,
        "problems": problems(findings),
    }


def as_text(findings: Findings) -> List[str]:
    """The findings and the problems, for people, line by line."""
    lines = [f"versions  {', '.join(f'{name} {version}' for name, version in findings.versions.items())}"]
    if findings.master is None:
        return [*lines, "master    none: nothing is running"]
    lines.append(f"master    {findings.master}" + _others(findings.other_masters))
    lines.append(f"clock     {_clock(findings)}")
    lines += _column("nodes", [_node_line(node) for node in findings.nodes])
    lines += _column("topics", [_topic_line(topic) for topic in findings.topics if topic.rate is not None])
    lines += _column("frames", branches(findings.parents))
    return lines + _column("problems", problems(findings) or ["none"])


def _clock_problems(findings: Findings) -> List[str]:
    clock = findings.topic("/clock")
    has_clock = clock is not None and bool(clock.publishers)
    if findings.uses_simulated_time and not has_clock:
        return ["use_sim_time is true, but nobody publishes /clock: every node waits for the time"]
    if has_clock and not findings.uses_simulated_time:
        return ["/clock is published, but use_sim_time is not true: the nodes go by the wall clock"]
    if has_clock and findings.real_time_factor == 0.0:
        return ["/clock stands still: the simulation is paused, or waits for a node"]
    return []


def _node_problems(findings: Findings) -> List[str]:
    dead = [f"{node.name} is registered but does not answer" for node in findings.nodes if not node.is_alive]
    waiting = [f"{node.name} waits for {what}" for node in findings.nodes for what in node.waits_for]
    return dead + waiting


def _topic_problems(findings: Findings) -> List[str]:
    found = []
    for topic in findings.topics:
        if (
            topic.name in ESSENTIAL_TOPICS
            and topic.subscribers
            and not topic.publishers
            and topic.name != "/clock"
        ):
            found.append(f"nobody publishes {topic.name}, for which {', '.join(topic.subscribers)} listens")
        elif topic.rate == 0.0 and topic.publishers and findings.real_time_factor != 0.0:
            found.append(f"nothing comes on {topic.name} from {', '.join(topic.publishers)}")
    return found


def _frame_problems(findings: Findings) -> List[str]:
    found = [
        f"frame {frame} has several parents: {', '.join(sorted(parents))}"
        for frame, parents in sorted(findings.parents.items())
        if len(parents) > 1
    ]
    roots = {parent for several in findings.parents.values() for parent in several} - set(findings.parents)
    if len(roots) > 1:
        found.append(f"the frames make {len(roots)} trees, with the roots {', '.join(sorted(roots))}")
    return found


def _others(masters: Sequence[str]) -> str:
    return f" (others: {', '.join(masters)}; choose with --master)" if masters else ""


def _clock(findings: Findings) -> str:
    if not findings.uses_simulated_time:
        return "wall clock (use_sim_time is not true)"
    if findings.real_time_factor is None:
        return "simulated, but nobody tells it"
    return f"simulated, {findings.real_time_factor:.2f} x real time"


def _node_line(node: Node) -> str:
    if not node.is_alive:
        return f"{node.name}: does not answer"
    return f"{node.name}: {'waits for ' + '; '.join(node.waits_for) if node.waits_for else 'ok'}"


def _topic_line(topic: Topic) -> str:
    return f"{topic.name}: {topic.rate:.1f} Hz from {', '.join(topic.publishers) or 'nobody'}"


def _column(title: str, entries: Sequence[str]) -> List[str]:
    return [f"{title if not number else '':<9} {entry}" for number, entry in enumerate(entries or ["none"])]
