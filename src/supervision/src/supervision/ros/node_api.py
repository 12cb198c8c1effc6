"""XML-RPC queries to the master and the nodes, with short time-outs."""

import xmlrpc.client
from contextlib import suppress
from itertools import chain
from typing import Any, Container, List, Set, Tuple

import rosgraph

from supervision.interruption import raise_if_interrupted

CALLER = "/home_service"
ANSWER_SECONDS = 1.0
_SILENCE = (OSError, xmlrpc.client.Error)


class TimedTransport(xmlrpc.client.Transport):
    """Transport with a time-out, for nodes that hang.

    Args:
        seconds: Time-out of a response [s].
    """

    def __init__(self, seconds: float = ANSWER_SECONDS):
        super().__init__()
        self._seconds = seconds

    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = self._seconds
        return connection


def is_master_online() -> bool:
    """Whether the master responds, as in rosgraph; an interruption during the call is not lost."""
    is_online = rosgraph.is_master_online()
    raise_if_interrupted()
    return is_online


def answers(uri: str) -> bool:
    """Whether the master or node at ``uri`` responds."""
    try:
        code, _pid = _ask(uri, "getPid")
    except _SILENCE:
        return False
    return code == 1


def node_names() -> Set[str]:
    """Return the nodes that publish, subscribe or serve; none if the master does not respond."""
    try:
        _code, state = _ask(rosgraph.get_master_uri(), "getSystemState")
    except _SILENCE:
        return set()
    return {node for part in state for _name, nodes in part for node in nodes}


def unresponsive_nodes() -> List[str]:
    """Return registered nodes that do not respond, without the leading slash."""
    uri = rosgraph.get_master_uri()
    silent = []
    for name in sorted(node_names()):
        with suppress(*_SILENCE):
            if not answers(_ask(uri, "lookupNode", name)[1]):
                silent.append(name.lstrip("/"))
    return silent


def receives_all(node: str, topics: Container[str]) -> bool:
    """Whether each publisher of ``topics`` sends to ``node`` by now."""
    master = rosgraph.get_master_uri()
    try:
        _code, (published, *_) = _ask(master, "getSystemState")
        publishers = {topic: nodes for topic, nodes in published if topic in topics}
        uris = {name: _ask(master, "lookupNode", name)[1] for name in {*chain(*publishers.values())}}
        receivers = {name: _receivers(uri) for name, uri in uris.items()}
    except _SILENCE:
        return False
    return all((topic, node) in receivers[name] for topic, names in publishers.items() for name in names)


def _receivers(uri: str) -> Set[Tuple[str, str]]:
    """Return each topic that a node sends, with the receiving node."""
    _code, connections = _ask(uri, "getBusInfo")
    return {(topic, peer) for _, peer, direction, _, topic, *_ in connections if direction == "o"}


def _ask(uri: str, question: str, *arguments: str) -> Tuple[int, Any]:
    """Return code and value of a call."""
    proxy: Any = xmlrpc.client.ServerProxy(uri, transport=TimedTransport())
    code, _status, value = getattr(proxy, question)(CALLER, *arguments)
    return code, value
