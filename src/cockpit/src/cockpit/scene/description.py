"""The visual parts of worlds and robots as triangle meshes."""

import io
import json
from dataclasses import astuple, dataclass
from typing import Dict, List, Tuple

import numpy as np

from cockpit.drawing import Colour

# Suffix of a file with the bytes of a SceneDescription.
DESCRIPTION_SUFFIX = ".npz"


@dataclass(frozen=True, eq=False)
class VisualPart:
    """A visual of a link as triangles.

    Attributes:
        model: Model of the link; empty for a robot.
        link: Name of the link.
        pose: Pose (4, 4) of the link in the world.
        vertices: Vertices (N, 3) in the link frame [m].
        triangles: Vertex indices (M, 3).
        colour: Colour of all triangles.
        moves: Whether the physics moves the link.
    """

    model: str
    link: str
    pose: np.ndarray
    vertices: np.ndarray
    triangles: np.ndarray
    colour: Colour
    moves: bool = False


@dataclass(frozen=True)
class DisplayJoint:
    """The joint of a door or a drawer.

    Attributes:
        model: Name of the model.
        name: Name of the joint in the model.
        shut: Closed position [rad or m].
        wide: Open position [rad or m].
    """

    model: str
    name: str
    shut: float
    wide: float

    def opened(self, share: float) -> float:
        """Return the position of an opening [rad or m].

        Args:
            share: 0 is closed, 1 is open.
        """
        return self.shut + share * (self.wide - self.shut)


@dataclass(frozen=True, eq=False)
class SceneDescription:
    """The visual parts of a world, a model or a robot.

    Attributes:
        parts: Visual parts.
        warnings: What cannot be displayed, and why.
        joints: Joints of doors and drawers.
    """

    parts: Tuple[VisualPart, ...]
    warnings: Tuple[str, ...] = ()
    joints: Tuple[DisplayJoint, ...] = ()

    def to_bytes(self) -> bytes:
        """Serialize for another process; ``from_bytes`` is the inverse."""
        about: List[dict] = []
        arrays: Dict[str, np.ndarray] = {}
        for number, part in enumerate(self.parts):
            about.append({"model": part.model, "link": part.link, "colour": part.colour, "moves": part.moves})
            arrays[f"p{number}"] = part.pose
            arrays[f"v{number}"] = part.vertices.astype(np.float32)
            arrays[f"t{number}"] = part.triangles.astype(np.int32)
        joints = [astuple(joint) for joint in self.joints]
        index = json.dumps({"parts": about, "warnings": self.warnings, "joints": joints})
        file = io.BytesIO()
        np.savez(file, index=np.array(index), **arrays)
        return file.getvalue()

    @staticmethod
    def from_bytes(content: bytes) -> "SceneDescription":
        with np.load(io.BytesIO(content)) as arrays:
            index = json.loads(str(arrays["index"]))
            parts = [
                VisualPart(
                    about["model"],
                    about["link"],
                    arrays[f"p{number}"],
                    arrays[f"v{number}"],
                    arrays[f"t{number}"],
                    tuple(about["colour"]),
                    about["moves"],
                )
                for number, about in enumerate(index["parts"])
            ]
        joints = tuple(DisplayJoint(*joint) for joint in index["joints"])
        return SceneDescription(tuple(parts), tuple(index["warnings"]), joints)


def cut_at(part: VisualPart, height: float) -> VisualPart:
    """Cut off the upper part of a visual; the result may be empty.

    Args:
        part: The visual.
        height: Height in the world above which it is cut off [m].
    """
    in_world = part.vertices @ part.pose[:3, :3].T + part.pose[:3, 3]
    if not len(in_world) or in_world[:, 2].max() <= height:
        return part
    if in_world[:, 2].min() >= height:
        return VisualPart(*_named(part), np.empty((0, 3)), np.empty((0, 3), int), part.colour, part.moves)
    in_world[:, 2] = np.minimum(in_world[:, 2], height)
    vertices = (in_world - part.pose[:3, 3]) @ part.pose[:3, :3]
    return VisualPart(*_named(part), vertices, part.triangles, part.colour, part.moves)


def _named(part: VisualPart) -> Tuple[str, str, np.ndarray]:
    return part.model, part.link, part.pose


def merged(parts: Tuple[VisualPart, ...]) -> List[Tuple[np.ndarray, np.ndarray, Colour]]:
    """Merge the visuals of one link to one mesh per colour.

    Returns:
        Vertices (N, 3) in the link frame [m], triangles (M, 3) and colour of each mesh.
    """
    by_colour: Dict[Colour, List[VisualPart]] = {}
    for part in parts:
        if len(part.triangles):
            by_colour.setdefault(part.colour, []).append(part)
    result = []
    for colour, same in by_colour.items():
        offsets = np.cumsum([0, *(len(part.vertices) for part in same)])
        triangles = np.concatenate([part.triangles + first for part, first in zip(same, offsets)])
        result.append((np.concatenate([part.vertices for part in same]), triangles, colour))
    return result
