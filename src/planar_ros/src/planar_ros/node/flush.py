"""Last words: what a node publishes before it ends reaches whoever listens."""

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
    """Waits, at most ``patience`` wall-clock seconds, until all subscribers have taken what was published.

    A node that just ended would take back its topic, upon which subscribers drop what they have not read. So
    each connection is closed for writing, which a subscriber answers by hanging up when it has read all.
    Nothing can be published afterwards.
    """
    deadline = time.monotonic() + patience
    transport.flush()  # what a node in step keeps until the moment's answer
    for publisher in publishers:
        # Asked anew each time, as listeners leave, too, where a whole graph is ended.
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
    """Has whoever listens then hear ``message`` when the node ends: rospy alone would drop it."""

    def say():
        publisher.publish(message)
        flush_and_close(publisher)

    rospy.on_shutdown(say)


def _flushed(publisher: rospy.Publisher, deadline: float) -> List[socket.socket]:
    """The sockets of a publisher once rospy has handed them all that waited."""
    connections = [each for each in publisher.impl.connections if not each.done]
    is_latched = publisher.impl.latch is not None
    while any(_is_at_work(each, is_latched) for each in connections) and time.monotonic() < deadline:
        time.sleep(POLL_SECONDS)
        transport.flush()  # also what is latched, for who has come just now
    time.sleep(POLL_SECONDS)  # for what has been taken out of a queue just now
    sockets = [getattr(each, "socket", None) for each in connections]
    return [each for each in sockets if each is not None]


def _is_at_work(connection: Any, is_latched: bool) -> bool:
    """Whether something waits to be sent; rospy sends what is latched to a new one just after it is there."""
    waiting = (getattr(connection, name, None) for name in ("_queue", "_rest", "_is_relaying", "_kept"))
    return any(waiting) or (is_latched and connection.stat_num_msg == 0)


def _wait_for_end(connection: socket.socket, deadline: float) -> None:
    """Until the other side has hung up."""
    with suppress(OSError):
        connection.settimeout(max(POLL_SECONDS, deadline - time.monotonic()))
        while connection.recv(1024):
            pass
