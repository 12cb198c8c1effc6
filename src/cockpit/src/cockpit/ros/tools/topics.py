"""Topics: type, rate, bandwidth and the newest message (rqt_topic)."""

from typing import Dict, Optional

from cockpit.errors import CockpitError
from cockpit.models.rates import RateMeter
from cockpit.models.tables import preformatted, table
from cockpit.models.text import outline
from cockpit.ros.graph import TopicFeed
from cockpit.ros.tool import ToolContext

NONE = "(none)"


class TopicsTool:
    name, title, seconds = "topics", "Topics", 0.5

    def __init__(self, context: ToolContext):
        self._context = context
        self._feeds: Dict[str, TopicFeed] = {}
        self._rates: Dict[str, RateMeter] = {}
        self._latest: Optional[str] = None
        # Why a topic is listed without figures.
        self._troubles: Dict[str, str] = {}

    def build(self) -> None:
        gui = self._context.gui
        self._filter = gui.add_text("Filter", "", hint="part of a topic's name")
        self._measured = gui.add_checkbox("Measure", False, hint="subscribe to all listed topics")
        self._list = gui.add_html("")
        self._watched = gui.add_dropdown("Watch", (NONE,))
        self._values = gui.add_html("")

    def update(self, now: float) -> None:
        types = {
            topic: kind
            for topic, kind in sorted(self._context.graph.topics().items())
            if self._filter.value.lower() in topic.lower()
        }
        options = (NONE, *types)
        if self._watched.options != options:
            self._watched.options = options
        self._subscribe(types)
        rows = [(topic, kind, *self._figures(topic, now)) for topic, kind in types.items()]
        self._list.content = table(("Topic", "Type", "Hz", "KB/s"), rows)
        self._show_values()

    def pause(self) -> None:
        for feed in self._feeds.values():
            feed.close()
        self._feeds.clear()
        self._rates.clear()

    def close(self) -> None:
        self.pause()

    def _subscribe(self, types: Dict[str, str]) -> None:
        wanted = set(types) if self._measured.value else set()
        wanted |= {self._watched.value} & set(types)
        for topic in set(self._feeds) - wanted:
            self._feeds.pop(topic).close()
            self._rates.pop(topic, None)
        for topic in sorted(wanted - set(self._feeds)):
            try:
                self._feeds[topic] = self._context.graph.feed(topic)
                self._rates[topic] = RateMeter()
                self._troubles.pop(topic, None)
            except CockpitError as error:  # of a type that is not installed
                self._troubles[topic] = str(error)

    def _figures(self, topic: str, now: float):
        feed = self._feeds.get(topic)
        if feed is None:
            return "", ""
        hertz, bytes_per_second = self._rates[topic].update(now, feed.count, feed.bytes)
        return f"{hertz:.1f}", f"{bytes_per_second / 1000.0:.1f}"

    def _show_values(self) -> None:
        feed = self._feeds.get(self._watched.value)
        if feed is None:
            self._latest = None
            self._values.content = preformatted(self._troubles.get(self._watched.value, ""))
            return
        messages = feed.messages()
        if messages:
            self._latest = outline(messages[-1])
        self._values.content = self._latest or "<i>no message yet</i>"


TOOL = TopicsTool
