"""Who listens to a topic."""

import socket
from contextlib import suppress
from typing import List
from urllib.parse import urlsplit

import rosgraph
import rospy

CONNECT_SECONDS = 0.5


def has_all_subscribers(publisher: rospy.Publisher) -> bool:
    """Whether somebody hears what is published now, and nobody who listens would miss it."""
    return publisher.get_num_connections() > 0 and are_all_connected(publisher)


def are_all_connected(publisher: rospy.Publisher) -> bool:
    """Whether all who listen now, if anybody does, are connected."""
    return publisher.get_num_connections() >= count_subscribers(publisher.resolved_name)


def count_subscribers(topic: str) -> int:
    """How many nodes listen to a topic."""
    master = rosgraph.Master(rospy.get_name())
    with suppress(OSError, rosgraph.MasterException):
        subscribers = dict(master.getSystemState()[1]).get(topic, ())
        return sum(_is_there(master, name) for name in set(subscribers) - {rospy.get_name()})
    return 0


def _is_there(master: rosgraph.Master, node: str) -> bool:
    """The master also knows nodes that were killed."""
    with suppress(OSError, rosgraph.MasterException):
        address = urlsplit(master.lookupNode(node))
        with socket.create_connection((address.hostname, address.port), CONNECT_SECONDS):
            return True
    return False


def remap_once(*names: str) -> List[str]:
    """The full names of topics, to be opened by these.

    rospy remaps a name once more where it opens the topic: with ``odom:=wheel_odom odom_faulty:=odom`` what
    is published on odom_faulty would come back on wheel_odom.
    """
    full = [rospy.resolve_name(name) for name in names]
    for name in full:
        rospy.names.get_resolved_mappings().pop(name, None)
    return full
