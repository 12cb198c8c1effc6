"""The ROS graph as the cockpit sees it: what there is, and what is listened to."""

import threading
import time
from collections import deque
from typing import Any, Callable, Deque, Dict, List, Optional, Tuple

import rosgraph
import roslib.message
import rospy
from rosgraph.masterapi import MasterError, MasterException

from cockpit.errors import CockpitError

CATALOGUE_SECONDS = 1.0
MOST_WAITING = 2000


class Feed:
    """A topic listened to: messages are kept as bytes, and made into messages only when they are taken.

    ``all_of_them``: keeps those that have not been taken yet, else the newest only. Whatever a person looks
    at, the graph is served first: receiving costs no more than a copy.
    """

    def __init__(self, topic: str, kind: str, all_of_them: bool = False):
        """Raises CockpitError if this system does not know the type."""
        message_class = roslib.message.get_message_class(kind)
        if message_class is None:
            raise CockpitError(f"{topic}: {kind} is a type that is not installed here")
        self.topic, self.kind = topic, kind
        self._class = message_class
        self._waiting: Deque[Tuple[float, bytes, str]] = deque(maxlen=MOST_WAITING if all_of_them else 1)
        self.count, self.bytes = 0, 0
        self._subscriber = rospy.Subscriber(topic, rospy.AnyMsg, self._on_message, tcp_nodelay=True)

    def take(self) -> List[Any]:
        """The messages that have come since the last call. Raises CockpitError if all are malformed."""
        return [message for _, message, _ in self.take_stamped()]

    def take_stamped(self) -> List[Tuple[float, Any, str]]:
        """The same, each with when it came, in seconds by a steady clock, and the node that sent it."""
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


class Graph:
    """Topics, nodes and services, asked of the master at most once a second."""

    def __init__(self):
        self._master = rosgraph.Master(rospy.get_name())
        self._lock = threading.Lock()
        self._asked = -CATALOGUE_SECONDS
        self._types: Dict[str, str] = {}
        self._state: Tuple[Dict[str, List[str]], ...] = ({}, {}, {})

    def topics(self) -> Dict[str, str]:
        """The type of each topic that anybody publishes or subscribes to. Raises CockpitError."""
        self._ask()
        return dict(self._types)

    def publishers(self) -> Dict[str, List[str]]:
        """The nodes that publish each topic. Raises CockpitError."""
        self._ask()
        return dict(self._state[0])

    def subscribers(self) -> Dict[str, List[str]]:
        """The nodes that subscribe to each topic. Raises CockpitError."""
        self._ask()
        return dict(self._state[1])

    def services(self) -> Dict[str, List[str]]:
        """The node behind each service. Raises CockpitError."""
        self._ask()
        return dict(self._state[2])

    def address(self, service: str) -> Optional[str]:
        """Where a service is offered, each time elsewhere if its node is started anew; None if it is not.

        Raises CockpitError.
        """
        return self._find(lambda: self._master.lookupService(service))

    def is_there(self) -> bool:
        """Whether the master answers."""
        try:
            self._ask()
        except CockpitError:
            return False
        return True

    def feed(self, topic: str, kind: Optional[str] = None, all_of_them: bool = False) -> Feed:
        """Listens to a topic. Raises CockpitError."""
        kind = kind or self.topics().get(topic)
        if kind is None:
            raise CockpitError(f"there is no topic {topic}")
        return Feed(topic, kind, all_of_them)

    def parameter(self, name: str, default: Any = None) -> Any:
        """Raises CockpitError. rospy would answer for "/" from its cache, once that holds anything."""
        return self._find(lambda: self._master.getParam(rospy.resolve_name(name)), default)

    def parameter_names(self) -> List[str]:
        """Raises CockpitError."""
        return _asking(rospy.get_param_names)

    def _find(self, ask: Callable[[], Any], default: Any = None) -> Any:
        """What the master says, ``default`` if it knows of none."""

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
    """Raises CockpitError, whatever went wrong on the way to the master."""
    try:
        return ask()
    except (OSError, MasterException, rospy.ROSException) as error:
        raise CockpitError(f"the ROS master does not answer ({error})") from None
