"""The look of worlds and robots: their visible parts as triangles."""

import io
import json
from dataclasses import astuple, dataclass
from typing import Dict, List, Tuple

import numpy as np

from cockpit.drawing import Colour


@dataclass(frozen=True, eq=False)
class VisualPart:
    """A visible part of a link: ``vertices`` (N, 3) in the link's frame, ``triangles`` (M, 3).

    ``model``, ``link``: what it belongs to; of a robot the model is empty. ``pose``: (4, 4) of the link in
    the world. ``moves``: whether anything but a person moves it.
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
    """A door or a drawer: the joint ``name`` of a ``model``, and where it is shut and wide open, rad or m."""

    model: str
    name: str
    shut: float
    wide: float

    def opened(self, share: float) -> float:
        """Its position when it is open by so much, 0 to 1."""
        return self.shut + share * (self.wide - self.shut)


@dataclass(frozen=True, eq=False)
class SceneDescription:
    """``warnings``: what cannot be shown, in words."""

    pieces: Tuple[VisualPart, ...]
    warnings: Tuple[str, ...] = ()
    joints: Tuple[DisplayJoint, ...] = ()

    def to_bytes(self) -> bytes:
        """As another process reads it with ``from_bytes``."""
        about: List[dict] = []
        arrays: Dict[str, np.ndarray] = {}
        for number, piece in enumerate(self.pieces):
            about.append(
                {"model": piece.model, "link": piece.link, "colour": piece.colour, "moves": piece.moves}
            )
            arrays[f"p{number}"] = piece.pose
            arrays[f"v{number}"] = piece.vertices.astype(np.float32)
            arrays[f"t{number}"] = piece.triangles.astype(np.int32)
        joints = [astuple(joint) for joint in self.joints]
        index = json.dumps({"pieces": about, "warnings": self.warnings, "joints": joints})
        file = io.BytesIO()
        np.savez(file, index=np.array(index), **arrays)
        return file.getvalue()

    @staticmethod
    def from_bytes(content: bytes) -> "SceneDescription":
        with np.load(io.BytesIO(content)) as arrays:
            index = json.loads(str(arrays["index"]))
            pieces = [
                VisualPart(
                    about["model"],
                    about["link"],
                    arrays[f"p{number}"],
                    arrays[f"v{number}"],
                    arrays[f"t{number}"],
                    tuple(about["colour"]),
                    about["moves"],
                )
                for number, about in enumerate(index["pieces"])
            ]
        joints = tuple(DisplayJoint(*joint) for joint in index["joints"])
        return SceneDescription(tuple(pieces), tuple(index["warnings"]), joints)


def cut_at(piece: VisualPart, height: float) -> VisualPart:
    """The piece without what is above ``height``, metres in the world; empty if it is all above."""
    in_world = piece.vertices @ piece.pose[:3, :3].T + piece.pose[:3, 3]
    if not len(in_world) or in_world[:, 2].max() <= height:
        return piece
    if in_world[:, 2].min() >= height:
        return VisualPart(*_named(piece), np.empty((0, 3)), np.empty((0, 3), int), piece.colour, piece.moves)
    in_world[:, 2] = np.minimum(in_world[:, 2], height)
    vertices = (in_world - piece.pose[:3, 3]) @ piece.pose[:3, :3]
    return VisualPart(*_named(piece), vertices, piece.triangles, piece.colour, piece.moves)


def _named(piece: VisualPart) -> Tuple[str, str, np.ndarray]:
    return piece.model, piece.link, piece.pose


def merged(pieces: Tuple[VisualPart, ...]) -> List[Tuple[np.ndarray, np.ndarray, Colour]]:
    """Vertices, triangles and colour, one of each colour, of pieces of one link."""
    by_colour: Dict[Colour, List[VisualPart]] = {}
    for piece in pieces:
        if len(piece.triangles):
            by_colour.setdefault(piece.colour, []).append(piece)
    result = []
    for colour, same in by_colour.items():
        offsets = np.cumsum([0, *(len(piece.vertices) for piece in same)])
        triangles = np.concatenate([piece.triangles + first for piece, first in zip(same, offsets)])
        result.append((np.concatenate([piece.vertices for piece in same]), triangles, colour))
    return result
