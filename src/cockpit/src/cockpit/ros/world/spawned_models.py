"""Models that are spawned and deleted while the simulation runs."""

from dataclasses import replace
from typing import Any, Callable, Dict, List, Optional, Tuple

from cockpit.frames import pose_from_message
from cockpit.page.world_view import WorldView
from cockpit.ros.graph import GraphClient, TopicFeed
from cockpit.ros.world.scene_reader import MODEL, SceneReader, SceneRequest, SceneResult
from cockpit.scene.description import SceneDescription

TYPE = "sim_bridge_msgs/SpawnedModels"


class SpawnedModelsView:
    """Shows the models that the simulator publishes.

    Args:
        graph: Client of the ROS graph.
        view: The displayed world.
        reader: Reads the models in child processes.
        notify: Shows a notification on the page.
    """

    def __init__(
        self, graph: GraphClient, view: WorldView, reader: SceneReader, notify: Callable[[str], None]
    ):
        self._graph, self._view, self._reader, self._notify = graph, view, reader, notify
        self._feed: Optional[TopicFeed] = None
        self._models: Dict[str, Any] = {}
        self._arrived: List[Tuple[List[Any], List[SceneResult]]] = []

    def poll(self) -> None:
        """Subscribe to the topic of spawned models, if there is one.

        Raises:
            CockpitError: The ROS master does not answer.
        """
        if self._feed is None:
            topics = (topic for topic, kind in self._graph.topics().items() if kind == TYPE)
            topic = next(topics, None)
            self._feed = None if topic is None else self._graph.feed(topic, TYPE)

    def update(self) -> None:
        """Read new models in the background, and show those that have been read.

        Raises:
            CockpitError: A message is malformed.
        """
        for message in self._feed.messages() if self._feed is not None else ():
            self._compare({model.name: model for model in message.models})
        while self._arrived:
            for model, answer in zip(*self._arrived.pop(0)):
                if self._models.get(model.name) == model:
                    self._show(model, answer)

    def unsubscribe(self) -> None:
        """End the subscription."""
        if self._feed is not None:
            self._feed.close()
            self._feed = None

    def _compare(self, models: Dict[str, Any]) -> None:
        """Remove deleted models and read new ones."""
        for name, model in self._models.items():
            if models.get(name) != model:
                self._view.remove(name)
        new = [model for name, model in models.items() if self._models.get(name) != model]
        self._models = models
        if new:
            requests: List[SceneRequest] = [(MODEL, model.name, model.xml) for model in new]
            self._reader.read_in_background(requests, lambda answers: self._arrived.append((new, answers)))

    def _show(self, model: Any, answer: SceneResult) -> None:
        pose = pose_from_message(model.pose.position, model.pose.orientation)
        if not isinstance(answer, SceneDescription):
            self._notify(f"{model.name}: {answer}")
        elif pose is not None:
            parts = tuple(replace(part, pose=pose @ part.pose) for part in answer.parts)
            self._view.show(replace(answer, parts=parts))
