"""The world and its robots in the scene."""

from itertools import groupby
from typing import Any, Dict, List, Optional, Tuple

import numpy as np

from cockpit.frames import FrameTree, wxyz_of
from cockpit.scene.description import DisplayJoint, SceneDescription, VisualPart, cut_at, merged

STILL = 1e-5


class LinkView:
    """Pieces that move together: a node of the scene with a surface for each colour."""

    def __init__(self, scene, path: str, pieces: Tuple[VisualPart, ...]):
        self._scene, self._path = scene, path
        self.pieces = pieces
        self.node = scene.add_frame(path, show_axes=False)
        self._surfaces: List[Any] = []
        self._pose: Optional[np.ndarray] = None

    def draw(self, height: float) -> None:
        """With nothing above ``height``, metres in the world."""
        for surface in self._surfaces:
            surface.remove()
        cut = tuple(cut_at(piece, height) for piece in self.pieces)
        self._surfaces = [
            self._scene.add_mesh_simple(
                f"{self._path}/{number}",
                vertices,
                triangles,
                color=colour,
                flat_shading=True,
                side="double",
            )
            for number, (vertices, triangles, colour) in enumerate(merged(cut))
        ]

    def move(self, pose: Optional[np.ndarray]) -> None:
        """``pose``: (4, 4) in the fixed frame; None hides it."""
        if self.node.visible != (pose is not None):
            self.node.visible = pose is not None
        if pose is None or (self._pose is not None and np.abs(pose - self._pose).max() < STILL):
            return
        if self._pose is None or np.abs(pose[:3, :3] - self._pose[:3, :3]).max() >= STILL:
            self.node.wxyz = wxyz_of(pose)
        self.node.position = pose[:3, 3]
        self._pose = pose

    def remove(self) -> None:
        self.node.remove()


class WorldView:
    """The models of a world, which stand where they were put until ``place`` says otherwise."""

    def __init__(self, scene):
        self._scene = scene
        self._things: Dict[str, LinkView] = {}
        self._poses: Dict[str, np.ndarray] = {}
        self._height = np.inf
        self.joints: Dict[str, DisplayJoint] = {}
        self.is_shown = True

    @property
    def movable(self) -> List[str]:
        """``model::link`` of what physics may move."""
        return [name for name, thing in self._things.items() if thing.pieces[0].moves]

    @property
    def models(self) -> List[str]:
        return sorted({thing.pieces[0].model for thing in self._things.values()})

    def show(self, look: SceneDescription) -> None:
        def thing_of(piece: VisualPart) -> str:
            return f"{piece.model}::{piece.link}"

        self.joints.update({f"{joint.model}: {joint.name}": joint for joint in look.joints})
        for name, pieces in groupby(sorted(look.pieces, key=thing_of), thing_of):
            thing = LinkView(self._scene, f"/world/{name.replace('/', ':')}", tuple(pieces))
            thing.draw(self._height)
            self._things[name] = thing
            self._poses[name] = thing.pieces[0].pose

    def remove(self, model: str) -> None:
        """If there is such a model."""
        for name in [name for name, thing in self._things.items() if thing.pieces[0].model == model]:
            self._things.pop(name).remove()
            del self._poses[name]
        self.joints = {name: joint for name, joint in self.joints.items() if joint.model != model}

    def cut(self, height: float) -> None:
        """Takes off what is above ``height``, metres: roofs, and the upper part of walls."""
        self._height = height
        for thing in self._things.values():
            thing.draw(height)

    def place(self, name: str, pose_in_world: np.ndarray) -> None:
        if name in self._poses:
            self._poses[name] = pose_in_world

    def move(self, model: str, motion: np.ndarray) -> None:
        """``motion``: (4, 4), from where the model was in the world to where it is."""
        for name, thing in self._things.items():
            if thing.pieces[0].model == model:
                self._poses[name] = motion @ self._poses[name]

    def update(self, world_in_fixed: Optional[np.ndarray]) -> None:
        for name, thing in self._things.items():
            shown = world_in_fixed is not None and self.is_shown
            thing.move(world_in_fixed @ self._poses[name] if shown else None)


class RobotView:
    """A robot's links, each where tf says; ``prefix`` is before the names of its frames."""

    def __init__(self, scene, name: str, look: SceneDescription, prefix: str):
        self._prefix = f"{prefix.strip('/')}/" if prefix.strip("/") else ""
        self._things: Dict[str, LinkView] = {}
        for link, pieces in groupby(sorted(look.pieces, key=_link), _link):
            path = f"/robots/{name.strip('/').replace('/', ':') or 'robot'}/{link}"
            self._things[link] = LinkView(scene, path, tuple(pieces))
            self._things[link].draw(np.inf)

    def update(self, frames: FrameTree, fixed: str, is_shown: bool) -> None:
        for link, thing in self._things.items():
            thing.move(frames.pose(self._prefix + link, fixed) if is_shown else None)

    def remove(self) -> None:
        for thing in self._things.values():
            thing.remove()


def _link(piece: VisualPart) -> str:
    return piece.link
