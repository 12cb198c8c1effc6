"""Whether a loop of nodes is closed: each hears all that the others send."""

import xmlrpc.client
from itertools import chain
from typing import Any, Collection, Dict, List, Set, Tuple

import rosgraph
import rospy

from planar_ros.lockstep.transport import ANSWER_TOPIC, STATIC_TOPIC

ANSWER_SECONDS = 1.0
_SILENCE = (OSError, xmlrpc.client.Error)
SystemState = Dict[str, List[str]]


class _TimedTransport(xmlrpc.client.Transport):
    def make_connection(self, host):
        connection = super().make_connection(host)
        connection.timeout = ANSWER_SECONDS
        return connection


class ConnectionCheck:
    """Asks the master and the nodes, none of which is waited for long."""

    def __init__(self):
        self._master = rosgraph.get_master_uri()
        self._uris: Dict[str, str] = {}

    def missing(
        self, members: Collection[str], observers: Collection[str], static_publishers: Collection[str]
    ) -> List[str]:
        """The connections that are still to come, for people.

        From a member to a member or an audience; for static transforms from their publishers to members.
        """
        try:
            published, subscribed, _ = self._state()
            wanted = {
                (sender, topic, receiver)
                for topic, senders in published.items()
                for sender in senders
                for receiver in subscribed.get(topic, ())
                if sender in members and (receiver in members or receiver in observers)
            }
            listeners = set(members).intersection(subscribed.get(STATIC_TOPIC, ()))
            wanted.update(
                (name, STATIC_TOPIC, receiver) for name in static_publishers for receiver in listeners
            )
            senders = {sender for sender, _, _ in wanted}.intersection(chain(*published.values()))
            there = set(chain(*(self._outgoing(name) for name in senders)))
        except _SILENCE as error:
            return [f"an answer of the nodes ({error})"]
        return [f"{topic} from {sender} to {receiver}" for sender, topic, receiver in sorted(wanted - there)]

    def known_nodes(self) -> Tuple[Set[str], Set[str]]:
        """The nodes that the master knows, and those of them that can be in step."""
        try:
            tables = self._state()
        except _SILENCE:
            return set(), set()
        names = set(chain(*(chain(*table.values()) for table in tables)))
        return names, set(tables[0].get(ANSWER_TOPIC, ()))

    def _state(self) -> Tuple[SystemState, SystemState, SystemState]:
        published, subscribed, services = _ask(self._master, "getSystemState")
        return dict(published), dict(subscribed), dict(services)

    def _outgoing(self, name: str) -> Set[Tuple[str, str, str]]:
        if name == rospy.get_name():
            bus = rospy.topics.get_topic_manager().get_pub_sub_info()
        else:
            if name not in self._uris:
                self._uris[name] = _ask(self._master, "lookupNode", name)
            try:
                bus = _ask(self._uris[name], "getBusInfo")
            except _SILENCE:
                del self._uris[name]
                raise
        return {(name, topic, receiver) for _, receiver, way, _, topic, *_ in bus if way == "o"}


def _ask(uri: str, question: str, *arguments: str) -> Any:
    proxy: Any = xmlrpc.client.ServerProxy(uri, transport=_TimedTransport())
    _code, _status, value = getattr(proxy, question)(rospy.get_name(), *arguments)
    return value
