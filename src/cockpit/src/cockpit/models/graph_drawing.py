"""The graph of nodes and topics in graphviz's language (rqt_graph)."""

from dataclasses import dataclass
from typing import Dict, Iterable, List, Mapping, Sequence, Set, Tuple

NODES, ACTIVE, ALL = "nodes only", "nodes and topics that are in use", "nodes and all topics"
KINDS = (NODES, ACTIVE, ALL)
DEBUG_NODES = ("/rosout", "/rqt", "/cockpit", "/record", "/play", "/rostopic")
DEBUG_TOPICS = ("/rosout", "/rosout_agg", "/statistics")
CLOCK, TRANSFORMS = ("/clock",), ("/tf", "/tf_static")
ACTION = frozenset(("goal", "cancel", "status", "feedback", "result"))
ACTION_TOPICS = "action"
NODE = 'shape=ellipse, style=filled, fillcolor="#fff9db"'
TOPIC = 'shape=box, style=filled, fillcolor="#e7f5ff"'
STYLE = """graph [rankdir=LR, bgcolor=transparent, nodesep=0.15, ranksep=0.35];
node [fontname="Helvetica", fontsize=11, height=0.3, margin="0.08,0.03"];
edge [fontname="Helvetica", arrowsize=0.6];"""
ARROW = 'fontsize=9, color="#868e96", fontcolor="#495057"'

# The publishing, or the subscribing, nodes of each topic.
Ends = Mapping[str, Sequence[str]]
Edge = Tuple[str, str]


@dataclass(frozen=True)
class GraphFilter:
    """Which part of the graph is drawn.

    Attributes:
        kind: One of KINDS: which nodes and topics are drawn.
        debug: Whether the log, the clock and the cockpit itself are drawn.
        transforms: Whether /tf and /tf_static are drawn.
        actions_apart: Whether the five topics of an action are drawn separately.
        part_of_name: Part of the names to draw; empty for all.
    """

    kind: str = ACTIVE
    debug: bool = False
    transforms: bool = True
    actions_apart: bool = False
    part_of_name: str = ""


def dot_of(publishers: Ends, subscribers: Ends, shown: GraphFilter) -> str:
    """Return the graph in graphviz's language.

    Args:
        publishers: Publishing nodes of each topic.
        subscribers: Subscribing nodes of each topic.
        shown: Which part is drawn.
    """
    writers, readers = _chosen(publishers, shown), _chosen(subscribers, shown)
    if shown.kind == NODES:
        return _nodes_only(writers, readers)
    lines: List[str] = []
    topics = sorted(set(writers) | set(readers))
    if shown.kind == ACTIVE:
        topics = [topic for topic in topics if writers.get(topic) and readers.get(topic)]
    for topic in topics:
        lines.append(f"{_id('t', topic)} [{TOPIC}, {_label(topic)}];")
        lines += [f"{_id('n', node)} -> {_id('t', topic)};" for node in sorted(writers.get(topic, ()))]
        lines += [f"{_id('t', topic)} -> {_id('n', node)};" for node in sorted(readers.get(topic, ()))]
    return _digraph(_nodes(writers, readers), lines)


def _nodes_only(writers: Dict[str, Set[str]], readers: Dict[str, Set[str]]) -> str:
    edges: Dict[Edge, List[str]] = {}
    for topic in sorted(set(writers) & set(readers)):
        for writer in writers[topic]:
            for reader in readers[topic]:
                edges.setdefault((writer, reader), []).append(topic)
    lines = [
        f"{_id('n', writer)} -> {_id('n', reader)} [{_label(*topics)}, {ARROW}];"
        for (writer, reader), topics in sorted(edges.items())
    ]
    return _digraph(_nodes(writers, readers), lines)


def _chosen(ends: Ends, shown: GraphFilter) -> Dict[str, Set[str]]:
    """Return the nodes of each topic that passes the filter."""
    hidden = (() if shown.debug else DEBUG_TOPICS + CLOCK) + (() if shown.transforms else TRANSFORMS)
    actions = set() if shown.actions_apart else _actions(ends)
    part = shown.part_of_name.lower()
    chosen: Dict[str, Set[str]] = {}
    for topic, nodes in ends.items():
        if topic in hidden:
            continue
        above, _, last = topic.rpartition("/")
        name = f"{above}/{ACTION_TOPICS}" if above in actions and last in ACTION else topic
        seen = {node for node in nodes if shown.debug or not node.startswith(DEBUG_NODES)}
        if part not in name.lower():
            seen = {node for node in seen if part in node.lower()}
        if seen:
            chosen.setdefault(name, set()).update(seen)
    return chosen


def _actions(ends: Iterable[str]) -> Set[str]:
    """Return the namespaces of actions: those with all topics of one side of an action."""
    found: Dict[str, Set[str]] = {}
    for topic in ends:
        above, _, last = topic.rpartition("/")
        found.setdefault(above, set()).add(last)
    return {
        above
        for above, lasts in found.items()
        if {"goal", "cancel"} <= lasts or {"status", "result"} <= lasts
    }


def _nodes(*sides: Dict[str, Set[str]]) -> List[str]:
    return sorted({node for side in sides for nodes in side.values() for node in nodes})


def _digraph(nodes: Iterable[str], lines: Iterable[str]) -> str:
    drawn = [f"{_id('n', node)} [{NODE}, {_label(node)}];" for node in nodes]
    return "\n".join(["digraph graph_of_nodes {", STYLE, *drawn, *lines, "}\n"])


def _id(kind: str, name: str) -> str:
    return f'"{kind}{_plain(name)}"'


def _label(*names: str) -> str:
    return 'label="{}"'.format("\\n".join(map(_plain, names)))


def _plain(name: str) -> str:
    """Escape a name for a string of graphviz."""
    return name.replace("\\", "\\\\").replace('"', '\\"')
