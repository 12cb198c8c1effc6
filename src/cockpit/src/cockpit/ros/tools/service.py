"""Service: battery, activity and the queue of requests of a running service."""

from typing import Optional

from cockpit.models.service import service_html
from cockpit.models.tables import paragraph
from cockpit.ros.graph import TopicFeed
from cockpit.ros.tool import ToolContext

TOPIC, TYPE = "/service/state", "std_msgs/String"


class ServiceTool:
    name, title, seconds = "service", "Service", 0.5

    def __init__(self, context: ToolContext):
        self._context = context
        self._feed: Optional[TopicFeed] = None

    def build(self) -> None:
        self._state = self._context.gui.add_html(
            paragraph("no service runs: ./scripts/service.sh starts one")
        )

    def update(self, now: float) -> None:
        if self._feed is None:
            self._feed = self._context.graph.feed(TOPIC, TYPE)
        for message in self._feed.messages()[-1:]:
            self._state.content = service_html(message.data)

    def pause(self) -> None:
        if self._feed is not None:
            self._feed.close()
            self._feed = None

    close = pause


TOOL = ServiceTool
