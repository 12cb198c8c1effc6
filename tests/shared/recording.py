"""Recording the messages of a topic."""

import re
import xmlrpc.client
from typing import Any, List

import rosgraph
import rospy
from waiting import wait_until

PORTS = re.compile(r"on port (\d+) to \[.*:(\d+) on socket")


class MessageRecorder:
    """Records the messages of a topic from now on."""

    def __init__(self, topic, kind):
        self.messages: List[Any] = []
        self._subscriber = rospy.Subscriber(topic, kind, self.messages.append, queue_size=1000)

    def next(self):
        return self.following(1)[0]

    def following(self, count):
        """Wait for the next ``count`` messages."""
        first = len(self.messages)
        wait_until("messages", lambda: len(self.messages) >= first + count)
        return self.messages[first : first + count]

    def is_connected(self):
        return is_connected_to_all(self._subscriber)

    def close(self):
        self._subscriber.unregister()


def is_connected_to_all(subscriber):
    """Return whether there are publishers and all of them send to the subscriber.

    A publisher starts to send some milliseconds after rospy's subscriber has counted the connection. Until
    then it may hold an earlier connection that this node has closed, so the ports are compared.
    """
    topic, master = subscriber.resolved_name, rosgraph.Master(rospy.get_name())
    try:
        published, *_ = master.getSystemState()
        uris = [master.lookupNode(node) for name, nodes in published if name == topic for node in nodes]
        ours = {own for own, _ in _ports(rospy.get_node_uri(), topic, "i")}
        theirs = [{peer for _, peer in _ports(uri, topic, "o")} for uri in uris]
    except (OSError, rosgraph.MasterException, xmlrpc.client.Error):
        return False
    return bool(uris) and all(ours & peers for peers in theirs)


def _ports(uri, topic, direction):
    """Return the (local port, remote port) of a node's established connections for a topic."""
    node: Any = xmlrpc.client.ServerProxy(uri)
    _code, _status, connections = node.getBusInfo(rospy.get_name())
    ends = [text for _, _, way, _, name, _, text in connections if (name, way) == (topic, direction)]
    return PORTS.findall("\n".join(ends))
