"""Models that are spawned into the simulation and deleted while it runs, as the simulator tells of them."""

from dataclasses import replace
from typing import Any, Callable, Dict, List, Optional, Tuple

from cockpit.frames import pose_from_message
from cockpit.page.world_view import WorldView
from cockpit.ros.graph import GraphClient, TopicFeed
from cockpit.ros.world.scene_reader import MODEL, SceneReader, SceneRequest, SceneResult
from cockpit.scene.description import SceneDescription

TYPE = "sim_bridge_msgs/SpawnedModels"


class SpawnedModelsView:
    """Shows them in the ``view``, where they were put."""

    def __init__(
        self, graph: GraphClient, view: WorldView, reader: SceneReader, notify: Callable[[str], None]
    ):
        self._graph, self._view, self._reader, self._notify = graph, view, reader, notify
        self._feed: Optional[TopicFeed] = None
        self._models: Dict[str, Any] = {}
        self._arrived: List[Tuple[List[Any], List[SceneResult]]] = []

    def poll(self) -> None:
        """Listens to who tells of them, if anybody does. Raises CockpitError."""
        if self._feed is None:
            told = (topic for topic, kind in self._graph.topics().items() if kind == TYPE)
            topic = next(told, None)
            self._feed = None if topic is None else self._graph.feed(topic, TYPE)

    def update(self) -> None:
        """Raises CockpitError."""
        for message in self._feed.messages() if self._feed is not None else ():
            self._compare({model.name: model for model in message.models})
        while self._arrived:
            for model, answer in zip(*self._arrived.pop(0)):
                if self._models.get(model.name) == model:
                    self._show(model, answer)

    def rest(self) -> None:
        """Nobody looks."""
        if self._feed is not None:
            self._feed.close()
            self._feed = None

    def _compare(self, models: Dict[str, Any]) -> None:
        """With those that are shown or being read."""
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
            pieces = tuple(replace(piece, pose=pose @ piece.pose) for piece in answer.pieces)
            self._view.show(replace(answer, pieces=pieces))
