"""Topics of a node: their subscribers, remapped names, and what is published before the node ends."""

import socket
import time
from contextlib import suppress
from typing import List
from urllib.parse import urlsplit

import genpy
import rosgraph
import rospy

from planar_ros.lockstep import transport
from rospy_transport.connections import OpenConnections, is_connected
from rospy_transport.node import discard_remapping

CONNECT_SECONDS = 0.5
# Time limit of flush_and_close, and the interval of its checks [wall s].
PATIENCE_SECONDS, POLL_SECONDS = 3.0, 0.01


def has_all_subscribers(publisher: rospy.Publisher) -> bool:
    """Return whether the topic has subscribers and all of them are connected."""
    return publisher.get_num_connections() > 0 and not unconnected_subscribers(publisher)


def unconnected_subscribers(publisher: rospy.Publisher) -> List[str]:
    """Return the nodes that subscribe to the topic but are not connected, so that a message misses them.

    They are compared by name: rospy also counts the connection of a node to itself.
    """
    master, topic = rosgraph.Master(rospy.get_name()), publisher.resolved_name
    with suppress(OSError, rosgraph.MasterException):
        nodes = dict(master.getSystemState()[1]).get(topic, ())
        missing = {node for node in nodes if not is_connected(publisher, node)} - {rospy.get_name()}
        return sorted(node for node in missing if _is_running(master, node))
    return []


def _is_running(master: rosgraph.Master, node: str) -> bool:
    """Return whether a node accepts connections; the master also lists nodes that were killed."""
    with suppress(OSError, rosgraph.MasterException):
        address = urlsplit(master.lookupNode(node))
        with socket.create_connection((address.hostname, address.port), CONNECT_SECONDS):
            return True
    return False


def remap_once(*names: str) -> List[str]:
    """Return the absolute names of topics that are to be opened with them.

    rospy remaps a name again where it opens the topic: with ``odom:=wheel_odom odom_faulty:=odom`` messages
    published on odom_faulty would appear on wheel_odom.
    """
    full = [rospy.resolve_name(name) for name in names]
    for name in full:
        discard_remapping(name)
    return full


def flush_and_close(*publishers: rospy.Publisher, patience: float = PATIENCE_SECONDS) -> None:
    """Wait until all subscribers have received what was published, then close the connections.

    When a node ends, its topics are unregistered, and subscribers drop unread messages. Therefore each
    connection is closed for writing, and a subscriber closes it when it has read everything. Nothing can be
    published afterwards.

    Args:
        publishers: Publishers.
        patience: Time limit for all of them [wall s].
    """
    deadline = time.monotonic() + patience
    transport.flush()  # messages that are batched until the end of the instant
    for publisher in publishers:
        # Queried each time, since subscribers leave as well when a whole graph shuts down.
        while unconnected_subscribers(publisher) and time.monotonic() < deadline:
            time.sleep(POLL_SECONDS)
        transport.remember_counts(publisher.resolved_name)
    sockets = [each for publisher in publishers for each in _flushed(publisher, deadline)]
    for each in sockets:
        with suppress(OSError):
            each.shutdown(socket.SHUT_WR)
    for each in sockets:
        _wait_for_end(each, deadline)


def publish_on_shutdown(publisher: rospy.Publisher, message: genpy.Message) -> None:
    """Publish a message when the node shuts down, and wait until subscribers have received it."""

    def publish():
        publisher.publish(message)
        flush_and_close(publisher)

    rospy.on_shutdown(publish)


def _flushed(publisher: rospy.Publisher, deadline: float) -> List[socket.socket]:
    """Return the sockets of a publisher once rospy has written all queued messages."""
    connections = OpenConnections(publisher)
    while connections.are_sending() and time.monotonic() < deadline:
        time.sleep(POLL_SECONDS)
        transport.flush()  # latched messages for new subscribers as well
    time.sleep(POLL_SECONDS)  # for messages just removed from a queue
    return connections.sockets()


def _wait_for_end(connection: socket.socket, deadline: float) -> None:
    """Wait until the other side has closed the connection."""
    with suppress(OSError):
        connection.settimeout(max(POLL_SECONDS, deadline - time.monotonic()))
        while connection.recv(1024):
            pass
