"""What the master and the nodes answer when asked by XML-RPC, none of which is waited for long."""

import xmlrpc.client
from itertools import chain
from typing import Container, Set, Tuple

import rosgraph

from supervision.interruption import raise_if_interrupted

CALLER = "/home_service"
ANSWER_SECONDS = 1.0
_SILENCE = (OSError, xmlrpc.client.Error)


class _TimedTransport(xmlrpc.client.Transport):
    """A transport that gives up on a node that hangs."""

    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = ANSWER_SECONDS
        return connection


def is_master_online() -> bool:
    """As rosgraph's function of that name, but what interrupts it is not lost."""
    is_online = rosgraph.is_master_online()
    raise_if_interrupted()
    return is_online


def answers(uri: str) -> bool:
    """Whether the master or node at ``uri`` is alive."""
    try:
        return _proxy(uri).getPid(CALLER)[0] == 1
    except _SILENCE:
        return False


def hears_all(node: str, topics: Container[str]) -> bool:
    """Whether each publisher of ``topics`` sends to ``node`` by now."""
    try:
        master = _proxy(rosgraph.get_master_uri())
        _code, _status, (published, *_) = master.getSystemState(CALLER)
        publishers = {topic: nodes for topic, nodes in published if topic in topics}
        uris = {name: master.lookupNode(CALLER, name)[2] for name in {*chain(*publishers.values())}}
        receivers = {name: _receivers(uri) for name, uri in uris.items()}
    except _SILENCE:
        return False
    return all((topic, node) in receivers[name] for topic, names in publishers.items() for name in names)


def _receivers(uri: str) -> Set[Tuple[str, str]]:
    """Each topic that a node sends, with the node that it is sent to."""
    _code, _status, connections = _proxy(uri).getBusInfo(CALLER)
    return {(topic, peer) for _, peer, direction, _, topic, *_ in connections if direction == "o"}


def _proxy(uri: str) -> xmlrpc.client.ServerProxy:
    return xmlrpc.client.ServerProxy(uri, transport=_TimedTransport())
