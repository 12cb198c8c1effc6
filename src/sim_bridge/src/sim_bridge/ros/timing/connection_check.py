"""Connection check: whether every subscriber of the synchronized nodes is connected to its publishers."""

import os
import socket
import xmlrpc.client
from itertools import chain
from typing import Any, Collection, Dict, List, Optional, Set, Tuple

import rosgraph
import rosgraph.network
import rospy

from planar_ros.lockstep.transport import ANSWER_TOPIC, STATIC_TOPIC
from rospy_transport.connections import outgoing
from supervision.ros.node_api import TimedTransport

ANSWER_SECONDS = 1.0
# Code of an answer to a call of the master or a node.
SUCCESS = 1
_UNAVAILABLE = (OSError, xmlrpc.client.Error)
NodesByName = Dict[str, List[str]]


class ConnectionCheck:
    """Queries the master and the nodes, with time-outs."""

    def __init__(self):
        self._master = rosgraph.get_master_uri()
        self._uris: Dict[str, str] = {}

    def missing(
        self, members: Collection[str], observers: Collection[str], static_publishers: Collection[str]
    ) -> List[str]:
        """Return descriptions of the missing connections.

        Args:
            members: Synchronized nodes; every connection between them is required, and from them to
                observers.
            observers: Unsynchronized nodes that must receive all messages.
            static_publishers: Nodes whose /tf_static the members must receive.
        """
        try:
            published, subscribed, _ = self._state()
            required = {
                (sender, topic, receiver)
                for topic, senders in published.items()
                for sender in senders
                for receiver in subscribed.get(topic, ())
                if sender != receiver and sender in members and (receiver in members or receiver in observers)
            }
            subscribers = set(members).intersection(subscribed.get(STATIC_TOPIC, ()))
            required.update(
                (name, STATIC_TOPIC, receiver) for name in static_publishers for receiver in subscribers
            )
            senders = {sender for sender, _, _ in required}.intersection(chain(*published.values()))
            established = set(chain(*(self._outgoing(name) for name in senders)))
        except _UNAVAILABLE as error:
            return [f"a reply of the nodes ({error})"]
        return [
            f"{topic} from {sender} to {receiver}"
            for sender, topic, receiver in sorted(required - established)
        ]

    def known_nodes(self) -> Tuple[Set[str], Set[str]]:
        """Return the nodes known to the master, and those of them that can be synchronized."""
        try:
            tables = self._state()
        except _UNAVAILABLE:
            return set(), set()
        names = set(chain(*(chain(*table.values()) for table in tables)))
        return names, set(tables[0].get(ANSWER_TOPIC, ()))

    def local_process(self, name: str = "") -> Optional[int]:
        """Return the process of a node on this machine; None without.

        Args:
            name: Name of the node; empty for the master.
        """
        try:
            uri = _query(self._master, "lookupNode", name) if name else self._master
            pid = _query(uri, "getPid") if _is_local(uri) else None
        except _UNAVAILABLE:
            return None
        return pid if pid and pid != os.getpid() else None

    def is_elsewhere(self, name: str) -> bool:
        """Return whether a node runs on another machine."""
        try:
            return not _is_local(_query(self._master, "lookupNode", name))
        except _UNAVAILABLE:
            return False

    def graph(self) -> Tuple[NodesByName, NodesByName, NodesByName]:
        """Return the nodes by published topic, by subscribed topic, by service; empty without the master."""
        try:
            return self._state()
        except _UNAVAILABLE:
            return {}, {}, {}

    def _state(self) -> Tuple[NodesByName, NodesByName, NodesByName]:
        published, subscribed, services = _query(self._master, "getSystemState")
        return dict(published), dict(subscribed), dict(services)

    def _outgoing(self, name: str) -> Set[Tuple[str, str, str]]:
        if name == rospy.get_name():
            return {(name, topic, receiver) for receiver, topic, _ in outgoing()}
        if name not in self._uris:
            self._uris[name] = _query(self._master, "lookupNode", name)
        try:
            bus = _query(self._uris[name], "getBusInfo")
        except _UNAVAILABLE:
            del self._uris[name]
            raise
        return {(name, topic, receiver) for _, receiver, direction, _, topic, *_ in bus if direction == "o"}


def _is_local(uri: str) -> bool:
    """Whether a node's address is one of this machine."""
    host = rosgraph.network.parse_http_host_and_port(uri)[0]
    own = {"localhost", "127.0.0.1", socket.gethostname(), *rosgraph.network.get_local_addresses()}
    return host in own


def _query(uri: str, method: str, *arguments: str) -> Any:
    proxy: Any = xmlrpc.client.ServerProxy(uri, transport=TimedTransport(ANSWER_SECONDS))
    code, status, value = getattr(proxy, method)(rospy.get_name(), *arguments)
    if code != SUCCESS:  # the master of a node that has gone
        raise ConnectionError(status)
    return value
