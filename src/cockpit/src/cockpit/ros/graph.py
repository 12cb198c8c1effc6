"""The ROS graph: topics, nodes, services and parameters of the master, and subscriptions."""

import threading
import time
from collections import deque
from typing import Any, Callable, Deque, Dict, List, Optional, Tuple

import rosgraph
import roslib.message
import rospy
from rosgraph.masterapi import MasterError, MasterException

from cockpit.errors import CockpitError
from planar.deprecation import renamed_method

CATALOGUE_SECONDS = 1.0
MOST_WAITING = 2000


class TopicFeed:
    """A subscription that stores serialized messages until they are read, so that receiving them only copies.

    Attributes:
        topic: Name of the topic.
        kind: Message type, "package/Type".
        count: Messages received so far.
        bytes: Bytes received so far.
    """

    def __init__(self, topic: str, kind: str, all_of_them: bool = False):
        """Subscribe.

        Args:
            topic: Name of the topic.
            kind: Message type, "package/Type".
            all_of_them: Keep every unread message (at most MOST_WAITING) instead of the newest only.

        Raises:
            CockpitError: If the message type is not installed.
        """
        message_class = roslib.message.get_message_class(kind)
        if message_class is None:
            raise CockpitError(f"{topic}: message type {kind} is not installed")
        self.topic, self.kind = topic, kind
        self._class = message_class
        self._waiting: Deque[Tuple[float, bytes, str]] = deque(maxlen=MOST_WAITING if all_of_them else 1)
        self.count, self.bytes = 0, 0
        self._subscriber = rospy.Subscriber(topic, rospy.AnyMsg, self._on_message, tcp_nodelay=True)

    def messages(self) -> List[Any]:
        """Return the messages received since the last call.

        Raises:
            CockpitError: All of them are malformed.
        """
        return [message for _, message, _ in self.stamped_messages()]

    take = renamed_method("take", "messages")

    def stamped_messages(self) -> List[Tuple[float, Any, str]]:
        """Return the messages received since the last call with their origin.

        Returns:
            Steady-clock time of arrival [s], message and publishing node of each message.

        Raises:
            CockpitError: All of them are malformed.
        """
        taken, trouble = [], ""
        while self._waiting:
            at, content, sender = self._waiting.popleft()
            message = self._class()
            try:
                message.deserialize(content)
            except Exception as error:  # genpy raises whatever struct and numpy do
                trouble = f"{self.topic}: not a {self.kind} ({error})"
            else:
                taken.append((at, message, sender))
        if trouble and not taken:
            raise CockpitError(trouble)
        return taken

    def close(self) -> None:
        self._subscriber.unregister()

    def _on_message(self, message) -> None:
        self.count += 1
        self.bytes += len(message._buff)
        self._waiting.append(
            (time.monotonic(), message._buff, message._connection_header.get("callerid", ""))
        )


class GraphClient:
    """Client of the ROS master; caches the lists of topics, nodes and services for a second.

    Methods that return something of the graph raise CockpitError if the master does not answer.
    """

    def __init__(self):
        self._master = rosgraph.Master(rospy.get_name())
        self._lock = threading.Lock()
        self._asked = -CATALOGUE_SECONDS
        self._types: Dict[str, str] = {}
        self._state: Tuple[Dict[str, List[str]], ...] = ({}, {}, {})

    def topics(self) -> Dict[str, str]:
        """Return the type of each topic with a publisher or a subscriber."""
        self._ask()
        return dict(self._types)

    def publishers(self) -> Dict[str, List[str]]:
        """Return the publishing nodes of each topic."""
        self._ask()
        return dict(self._state[0])

    def subscribers(self) -> Dict[str, List[str]]:
        """Return the subscribing nodes of each topic."""
        self._ask()
        return dict(self._state[1])

    def services(self) -> Dict[str, List[str]]:
        """Return the providers of each service."""
        self._ask()
        return dict(self._state[2])

    def address(self, service: str) -> Optional[str]:
        """Return the URI of a service, which changes when its node restarts; None if there is no service."""
        return self._find(lambda: self._master.lookupService(service))

    def is_there(self) -> bool:
        """Return whether the master responds."""
        try:
            self._ask()
        except CockpitError:
            return False
        return True

    def feed(self, topic: str, kind: Optional[str] = None, all_of_them: bool = False) -> TopicFeed:
        """Subscribe to a topic.

        Args:
            topic: Name of the topic.
            kind: Message type, "package/Type"; None for the published type.
            all_of_them: Whether every unread message is stored instead of the newest only.

        Raises:
            CockpitError: There is no such topic, or its message type is not installed.
        """
        kind = kind or self.topics().get(topic)
        if kind is None:
            raise CockpitError(f"there is no topic {topic}")
        return TopicFeed(topic, kind, all_of_them)

    def parameter(self, name: str, default: Any = None) -> Any:
        """Return a parameter from the master; rospy would answer "/" from its cache.

        Args:
            name: Name of the parameter or namespace.
            default: Value of a parameter that does not exist.
        """
        return self._find(lambda: self._master.getParam(rospy.resolve_name(name)), default)

    def parameter_names(self) -> List[str]:
        """Return the names of all parameters."""
        return _asking(rospy.get_param_names)

    def _find(self, ask: Callable[[], Any], default: Any = None) -> Any:
        """Ask the master; ``default`` if the name is unknown."""

        def find() -> Any:
            try:
                return ask()
            except MasterError:
                return default

        with self._lock:
            return _asking(find)

    def _ask(self) -> None:
        with self._lock:
            if time.monotonic() - self._asked < CATALOGUE_SECONDS:
                return
            types = dict(_asking(self._master.getTopicTypes))
            state = _asking(self._master.getSystemState)
            self._state = tuple(dict(part) for part in state)
            used = {*self._state[0], *self._state[1]}
            self._types = {topic: kind for topic, kind in types.items() if topic in used and kind != "*"}
            self._asked = time.monotonic()


def _asking(ask: Callable[[], Any]) -> Any:
    """Convert every failure to reach the master to a CockpitError."""
    try:
        return ask()
    except (OSError, MasterException, rospy.ROSException) as error:
        raise CockpitError(f"the ROS master does not answer ({error})") from None
