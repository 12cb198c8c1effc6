"""The log messages of all nodes since the cockpit was started."""

from typing import Optional

from cockpit.models.log import LogBuffer, LogEntry
from cockpit.ros.graph import GraphClient, TopicFeed

AGGREGATED, ROSOUT, KIND = "/rosout_agg", "/rosout", "rosgraph_msgs/Log"


class LogCollector:
    """Stores log messages, also while no page is open: the console shows what came before it.

    Args:
        graph: Client of the ROS graph.

    Attributes:
        entries: The newest log messages.
    """

    def __init__(self, graph: GraphClient):
        self._graph = graph
        self._feed: Optional[TopicFeed] = None
        self.entries = LogBuffer()

    def update(self) -> None:
        """Store the messages received since the last call.

        Raises:
            CockpitError: The ROS master does not answer, or the messages are malformed.
        """
        for message in self._subscribed().messages():
            where = f"{message.file.rpartition('/')[2]}:{message.line} {message.function}".strip(": ")
            stamp = message.header.stamp.to_sec()
            self.entries.add(LogEntry(message.level, stamp, message.name, message.msg, where))

    def _subscribed(self) -> TopicFeed:
        """Subscribe to /rosout_agg or, without rosout running, to /rosout."""
        wanted = AGGREGATED if AGGREGATED in self._graph.publishers() else ROSOUT
        if self._feed is not None and self._feed.topic != wanted:
            self._feed.close()
            self._feed = None
        if self._feed is None:
            self._feed = self._graph.feed(wanted, KIND, all_of_them=True)
        return self._feed
