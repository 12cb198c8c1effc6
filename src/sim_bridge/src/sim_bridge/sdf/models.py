"""Reads the models of a world, with their includes, as trees with relative names and poses."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Dict, Iterator, List, Optional, Sequence

import numpy as np

from sim_bridge.sdf.element import Element, parse, parse_text
from sim_bridge.sdf.frames import SdfFrames
from sim_bridge.sdf.includes import has_model, model_file, resolve
from sim_bridge.sdf.supported import DOCK, DRIVES, plugin_name
from sim_bridge.sdf.warnings import SkippedElements

MAX_INCLUDE_DEPTH = 20
# Gazebo models that are built in.
GROUND_PLANE, SUN = "ground_plane", "sun"
_GROUND_PLANE_SDF = """<sdf version='1.6'><model name='ground_plane'><static>1</static><link name='link'>
<collision name='collision'><geometry><plane><normal>0 0 1</normal></plane></geometry></collision>
<visual name='visual'><geometry><plane><normal>0 0 1</normal></plane></geometry><material><script>
<name>Gazebo/Grey</name></script></material></visual></link></model></sdf>"""


@dataclass
class SdfModel:
    """A <model>, or the model that an <include> names.

    Attributes:
        name: Name in its parent.
        element: The <model> element.
        placed_by: The element with its pose: the <include> if that has one.
        folder: Folder to which relative paths in it refer.
        is_static: Whether it is static.
        nested: Models nested in it.
    """

    name: str
    element: Element
    placed_by: Element
    folder: Path
    is_static: bool
    nested: List["SdfModel"] = field(default_factory=list)

    def __post_init__(self):
        self._by_name: Dict[str, SdfModel] = {}
        self.frames = SdfFrames(self._frames_of_nested)
        for joint in self.element.children("joint"):
            child = joint.child("child")
            self.frames.declare(joint.name, joint, child.text if child is not None else "")
        # After the joints: before SDF 1.7 a joint may have the name of a link, which then refers to the link.
        for link in self.element.children("link"):
            self.frames.declare(link.name, link)
        declare_frames(self.frames, self.element)

    @property
    def is_driven(self) -> bool:
        """Whether it has a drive plugin and is therefore a robot."""
        return not self.is_static and self._has_plugin(DRIVES)

    @property
    def is_dock(self) -> bool:
        """Whether it is a dock."""
        return self._has_plugin((DOCK,))

    def _has_plugin(self, names: Sequence[str]) -> bool:
        """Return whether one of its plugins has one of these names; the others do not count as read."""
        found = [
            child
            for child in self.element.children()
            if child.tag == "plugin" and plugin_name(child) in names
        ]
        for plugin in found:
            plugin.document.mark(plugin.xml)
        return bool(found)

    def add(self, model: "SdfModel") -> None:
        """Add a nested model."""
        self.nested.append(model)
        self._by_name[model.name] = model
        self.frames.declare(model.name, model.placed_by, inside=model.placement())

    def placement(self) -> np.ndarray:
        """Return the pose (4, 4) in this model of the frame that its <pose> places."""
        placement = self.placed_by.child("placement_frame")
        name = placement.text if placement is not None else self.element.attribute("placement_frame")
        return self.frames.frame(name, self.element)

    def _frames_of_nested(self, name: str) -> Optional[SdfFrames]:
        return self._by_name[name].frames if name in self._by_name else None


def declare_frames(frames: SdfFrames, parent: Element) -> None:
    """Declare the <frame> elements of a world or model."""
    for frame in parent.children("frame"):
        frame.mark_all()
        frames.declare(frame.name, frame, frame.attribute("attached_to"))


class ModelReader:
    """Reads models and includes; each file is read once.

    Args:
        model_folders: Folders of included models (GAZEBO_MODEL_PATH).
        warnings: Receives warnings about missing models and unsupported elements.
    """

    def __init__(self, model_folders: Sequence[Path], warnings: SkippedElements):
        self._model_folders = model_folders
        self._warnings = warnings
        self._files: Dict[Path, Element] = {}

    @property
    def roots(self) -> Sequence[Element]:
        """Root elements of the files that have been read."""
        return list(self._files.values())

    def models_in(
        self, parent: Element, folder: Path, static: bool = False, depth: int = 0
    ) -> Iterator[SdfModel]:
        """Yield the models below an element.

        Args:
            parent: A <world> or <model>.
            folder: Folder to which relative paths refer.
            static: Whether the parent is static; its models are then static, too.
            depth: Number of includes that the parent is nested in.
        """
        for element in parent.children("model"):
            yield self.model(element, element, folder, element.name, static, depth)
        for include in parent.children("include"):
            model = self.included(include, folder, static, depth)
            if model is not None:
                yield model

    def model(
        self,
        element: Element,
        placed_by: Element,
        folder: Path,
        name: str,
        static: bool = False,
        depth: int = 0,
    ) -> SdfModel:
        """Read a <model> with its nested models.

        Args:
            element: The <model>.
            placed_by: The element with its pose: the <include> if that has one.
            folder: Folder to which relative paths refer.
            name: Name in its parent.
            static: Whether the parent is static.
            depth: Number of includes that it is nested in.
        """
        static = static or element.flag("static")
        model = SdfModel(name, element, placed_by, folder, static)
        for nested in self.models_in(element, folder, static, depth):
            model.add(nested)
        return model

    def included(
        self, include: Element, folder: Path, static: bool = False, depth: int = 0
    ) -> Optional[SdfModel]:
        """Read the model that an <include> names; None if it is missing.

        The <name>, <pose> and <static> of the include take precedence.

        Args:
            include: The <include>.
            folder: Folder to which relative paths refer.
            static: Whether the parent is static.
            depth: Number of includes that it is nested in.

        Raises:
            WorldError: The model includes itself, or its file cannot be read.
        """
        if depth >= MAX_INCLUDE_DEPTH:
            raise include.error("includes itself")
        uri = include.required("uri").text
        builtin = built_in(uri)
        if builtin == SUN:
            include.mark_all()
            return None
        if builtin == GROUND_PLANE:
            model = parse_text(_GROUND_PLANE_SDF, uri).required("model")
        else:
            found = resolve(uri, folder, self._model_folders)
            if found is None or not has_model(found):
                self._warnings.missing(include, f"model {uri} not found")
                return None
            file = model_file(found)
            folder = file.parent
            model = self._root_of(file).required("model")
        model.child("pose")  # overridden if the include has one
        name = include.child("name")
        return self.model(
            model,
            include if include.child("pose") is not None else model,
            folder,
            name.text if name is not None and name.text else model.name,
            static or include.flag("static"),
            depth + 1,
        )

    def _root_of(self, file: Path) -> Element:
        if file not in self._files:
            self._files[file] = parse(file)
        return self._files[file]


def built_in(uri: str) -> str:
    """Return the name of a model that may be built in; empty for other URIs.

    Args:
        uri: ``model://ground_plane``, for example, or the URI of a model of Gazebo Fuel.
    """
    scheme, _, path = uri.partition("://")
    if scheme == "model":
        return path.strip("/")
    is_of_fuel = scheme in ("http", "https") and "/openrobotics/models/" in path.lower()
    return path.rstrip("/").rsplit("/", 1)[-1].lower().replace(" ", "_") if is_of_fuel else ""
