"""Meshes of COLLADA, STL and OBJ files as triangles in metres."""

from pathlib import Path
from typing import Any, Sequence

import numpy as np

from sim_bridge.errors import WorldError
from sim_bridge.shapes import Mesh


def load_mesh(path: Path, scale: Sequence[float], submesh: str = "", centred: bool = False) -> Mesh:
    """The triangles of a mesh file, or of its part named ``submesh`` (put at its centre if ``centred``).

    A COLLADA file's unit is honoured; like Gazebo, its up axis is not. Raises WorldError.
    """
    import trimesh

    try:
        scene: Any = trimesh.load(str(path), force="scene")
        parts = [(node, *scene.graph[node]) for node in scene.graph.nodes_geometry]
        chosen = [
            scene.geometry[name].copy().apply_transform(placed)
            for node, placed, name in parts
            if submesh in ("", node, name)
        ]
    except Exception as error:  # the many parsers below trimesh.load share no error class
        raise WorldError(f"{path}: not a readable mesh ({type(error).__name__}: {error})") from None
    if not chosen:
        raise WorldError(f"{path}: holds no mesh" + (f" named {submesh!r}" if submesh else ""))
    unit = float(str(chosen[0].metadata.get("units", "1")).split()[0].replace("meters", "1"))
    mesh = trimesh.util.concatenate(chosen)
    vertices = np.asarray(mesh.vertices, dtype=float) * unit
    if not len(mesh.faces) or not np.isfinite(vertices).all():
        raise WorldError(f"{path}: holds no triangles, or coordinates that are not numbers")
    if centred:
        vertices = vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2.0
    return Mesh(vertices * np.asarray(scale), np.asarray(mesh.faces, dtype=np.int64))
