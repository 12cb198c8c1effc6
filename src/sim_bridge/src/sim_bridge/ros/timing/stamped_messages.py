"""Progress of nodes by the stamps of their messages."""

import struct
import threading
from typing import Callable, Optional

import rospy

# Time in which a node that is paced by its stamps must send a message [wall s].
FIRST_MESSAGE_SECONDS = 10.0
# Start of a serialized header: seq, and the stamp in seconds and nanoseconds.
HEADER = struct.Struct("<III")


class StampedMessages:
    """Subscribes to topics of nodes and reports the stamps of what they publish.

    Args:
        follow: Called with a node, without slash, whose stamps will be reported.
        report: Called with such a node and a stamp [s], in any thread.
    """

    def __init__(self, follow: Callable[[str], None], report: Callable[[str, float], object]):
        self._follow, self._report = follow, report

    def follow(self, name: str, topic: str) -> None:
        """Report the stamps of the messages that a node, without slash, publishes on a topic."""

        def on_message(message: rospy.AnyMsg) -> None:
            unanswered.cancel()
            header = message._connection_header
            stamp = stamp_of(message._buff, header.get("message_definition", ""))
            if stamp is None:
                rospy.logwarn_once(
                    "%s (%s) starts with no header: pace %s by another topic", topic, header.get("type"), name
                )
            elif header.get("callerid", f"/{name}") == f"/{name}":
                self._report(name, stamp)

        text = "%s has sent nothing on %s for %g s: the simulation goes on in real time"
        arguments = (text, name, topic, FIRST_MESSAGE_SECONDS)
        unanswered = threading.Timer(FIRST_MESSAGE_SECONDS, rospy.logwarn, arguments)
        unanswered.daemon = True
        unanswered.start()
        self._follow(name)
        rospy.Subscriber(topic, rospy.AnyMsg, on_message, queue_size=100, tcp_nodelay=True)


def stamp_of(data: bytes, definition: str) -> Optional[float]:
    """Return the stamp of a serialized message [s]; None if it does not start with a header.

    Args:
        data: The message.
        definition: Definition of its type.
    """
    lines = (line.split("#")[0].split() for line in definition.splitlines())
    first = next((line for line in lines if line and "=" not in "".join(line)), [""])
    if first[0] not in ("Header", "std_msgs/Header") or len(data) < HEADER.size:
        return None
    _, seconds, nanoseconds = HEADER.unpack_from(data)
    return float(seconds) + 1e-9 * float(nanoseconds)
