"""Subscribers of topics, and remapping of topic names."""

import socket
from contextlib import suppress
from typing import List
from urllib.parse import urlsplit

import rosgraph
import rospy

CONNECT_SECONDS = 0.5


def has_all_subscribers(publisher: rospy.Publisher) -> bool:
    """Return whether the topic has subscribers and all of them are connected."""
    return publisher.get_num_connections() > 0 and are_all_connected(publisher)


def are_all_connected(publisher: rospy.Publisher) -> bool:
    """Return whether all current subscribers, if any, are connected."""
    return publisher.get_num_connections() >= count_subscribers(publisher.resolved_name)


def count_subscribers(topic: str) -> int:
    """Return the number of other nodes that subscribe to a topic."""
    master = rosgraph.Master(rospy.get_name())
    with suppress(OSError, rosgraph.MasterException):
        subscribers = dict(master.getSystemState()[1]).get(topic, ())
        return sum(_is_running(master, name) for name in set(subscribers) - {rospy.get_name()})
    return 0


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
        rospy.names.get_resolved_mappings().pop(name, None)
    return full
