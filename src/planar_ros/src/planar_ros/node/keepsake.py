"""What a node leaves for the next of its name, should it end all of a sudden."""

import json
import xmlrpc.client
from contextlib import suppress
from typing import Any, Optional

import rosgraph
import rospy

from planar_ros.node.parameters import ParameterWriter


class ParameterCheckpoint:
    """A value made of what JSON knows, in the parameter ``~keepsake/value`` of the master.

    Whoever is started anew after a crash or a ``kill -9`` finds it; a node that ends in order takes it away.
    For one thread.
    """

    def __init__(self):
        self._name = rospy.resolve_name("~keepsake/value")
        self._writer = ParameterWriter()
        self._kept = rospy.get_param(self._name, "")
        rospy.on_shutdown(self._forget)

    @property
    def found(self) -> Optional[Any]:
        """What an earlier node has left, or this one has kept since; None if there is nothing."""
        return json.loads(self._kept) if self._kept else None

    def keep(self, value: Any) -> None:
        """From now on this is what is found; costs nothing if it is the same."""
        text = json.dumps(value)
        if text != self._kept:
            self._kept = text
            self._writer.write({self._name: text})

    def _forget(self) -> None:
        with suppress(OSError, xmlrpc.client.Error):  # a master that is gone has nothing left to forget
            xmlrpc.client.ServerProxy(rosgraph.get_master_uri()).deleteParam(rospy.get_name(), self._name)
