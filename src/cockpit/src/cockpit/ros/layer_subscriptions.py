"""Subscriptions of layers: topics that are enabled while a page is open."""

from typing import Any, Callable, Dict, List, Optional

from cockpit.drawing import CameraImage, LayerUpdate
from cockpit.errors import CockpitError
from cockpit.layer import DisplayLayer, Draw
from cockpit.layers import by_type
from cockpit.page.scene_renderer import SceneRenderer
from cockpit.ros.graph import GraphClient, TopicFeed
from cockpit.ros.tool import error_text


class LayerSubscription:
    """The subscription of an enabled topic."""

    def __init__(self, graph: GraphClient, topic: str, kind: str, layer: DisplayLayer):
        """Subscribe. Raises CockpitError."""
        self.topic, self.layer = topic, layer
        self._feed: TopicFeed = graph.feed(topic, kind, layer.needs_all)
        self.reset()

    def reset(self) -> None:
        self._draw: Draw = self.layer.make()
        self._due = 0.0

    def updates(self, now: float) -> List[LayerUpdate]:
        """Draw the new messages.

        Args:
            now: Steady-clock time [s].

        Raises:
            Exception: Any exception of the layer.
        """
        if now < self._due:
            return []
        messages = self._feed.messages()
        if messages:
            self._due = now + self.layer.seconds
        return [self._draw(message) for message in messages]

    def close(self) -> None:
        self._feed.close()


class LayerManager:
    """Manages the topics that a layer can draw."""

    def __init__(self, graph: GraphClient, drawer: SceneRenderer, notify: Callable[[str], None]):
        self._graph, self._drawer, self._notify = graph, drawer, notify
        self._by_type = by_type()
        self._shown: Dict[str, LayerSubscription] = {}
        self._complaints: Dict[str, str] = {}
        # The newest image of each camera.
        self.screens: Dict[str, Any] = {}

    def offers(self) -> Dict[str, DisplayLayer]:
        """Return the layer of each published topic that a layer can draw.

        Raises:
            CockpitError: The ROS master does not answer.
        """
        published, types = self._graph.publishers(), self._graph.topics()
        known = ((topic, self._by_type.get(types.get(topic, ""))) for topic in sorted(published))
        return {topic: layer for topic, layer in known if layer is not None}

    def choose(self, wanted: Dict[str, bool], offers: Dict[str, DisplayLayer]) -> None:
        """Subscribe to the enabled topics only.

        Args:
            wanted: Whether each listed topic is enabled.
            offers: Layer of each published topic.
        """
        for topic in [topic for topic in self._shown if not wanted.get(topic)]:
            self._close(topic)
        for topic, is_on in wanted.items():
            if is_on and topic not in self._shown and topic in offers:
                self._open(topic, offers[topic])

    def update(self, now: float) -> None:
        for topic, shown in self._shown.items():
            try:
                for update in shown.updates(now):
                    self._show(topic, update, now)
                    self._complain(topic, update.warning)
            except Exception as error:  # messages of a graph may be malformed in any way
                self._complain(topic, error_text(error))

    def reset(self) -> None:
        """Clear all layers after ROS time has jumped back."""
        for topic, shown in self._shown.items():
            shown.reset()
            self._clear(topic)

    def close(self) -> None:
        """End all subscriptions; the scene is kept for the next client."""
        for shown in self._shown.values():
            shown.close()
        self._shown.clear()

    def _open(self, topic: str, layer: DisplayLayer) -> None:
        try:
            self._shown[topic] = LayerSubscription(self._graph, topic, layer_type(self._graph, topic), layer)
        except CockpitError as error:
            self._complain(topic, str(error))

    def _close(self, topic: str) -> None:
        self._shown.pop(topic).close()
        self._clear(topic)

    def _clear(self, topic: str) -> None:
        self._drawer.clear(topic)
        self.screens.pop(topic, None)

    def _show(self, topic: str, update: LayerUpdate, now: float) -> None:
        screens = [part for part in update.parts if isinstance(part.shape, CameraImage)]
        for part in screens:
            self.screens[topic] = part.shape.picture  # type: ignore[union-attr]
        if not screens:
            self._drawer.show(topic, update, now)

    def _complain(self, topic: str, text: str) -> None:
        """Report a text once for each topic until it changes."""
        if text and self._complaints.get(topic) != text:
            self._notify(f"{topic}: {text}")
        self._complaints[topic] = text or self._complaints.get(topic, "")


def layer_type(graph: GraphClient, topic: str) -> str:
    """Return the type of a topic.

    Raises:
        CockpitError: There is no such topic, or the ROS master does not answer.
    """
    kind: Optional[str] = graph.topics().get(topic)
    if kind is None:
        raise CockpitError("the topic no longer exists")
    return kind
