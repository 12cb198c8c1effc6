"""Flush on shutdown: what a node publishes before it ends reaches its subscribers."""

import socket
import time
from contextlib import suppress
from typing import Any, List

import genpy
import rospy

from planar_ros.lockstep import transport
from planar_ros.node.topics import are_all_connected

PATIENCE_SECONDS = 3.0
POLL_SECONDS = 0.01


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
        while not are_all_connected(publisher) and time.monotonic() < deadline:
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
    connections = [each for each in publisher.impl.connections if not each.done]
    is_latched = publisher.impl.latch is not None
    while any(_is_sending(each, is_latched) for each in connections) and time.monotonic() < deadline:
        time.sleep(POLL_SECONDS)
        transport.flush()  # latched messages for new subscribers as well
    time.sleep(POLL_SECONDS)  # for messages just removed from a queue
    sockets = [getattr(each, "socket", None) for each in connections]
    return [each for each in sockets if each is not None]


def _is_sending(connection: Any, is_latched: bool) -> bool:
    """Return whether messages are queued; rospy sends a latched one shortly after a connection is made."""
    queued = (getattr(connection, name, None) for name in ("_queue", "_rest", "_is_relaying", "_batch"))
    return any(queued) or (is_latched and connection.stat_num_msg == 0)


def _wait_for_end(connection: socket.socket, deadline: float) -> None:
    """Wait until the other side has closed the connection."""
    with suppress(OSError):
        connection.settimeout(max(POLL_SECONDS, deadline - time.monotonic()))
        while connection.recv(1024):
            pass
