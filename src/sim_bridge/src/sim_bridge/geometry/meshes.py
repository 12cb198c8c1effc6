"""Meshes of COLLADA, STL and OBJ files as triangles in metres, kept converted in a cache."""

import hashlib
import io
import logging
import os
import re
import tempfile
from pathlib import Path
from typing import Any, Optional, Sequence

import numpy as np

from planar.files.reading import read_arrays, read_bytes, read_text
from planar.geometry.limits import MAX_COORDINATE
from sim_bridge.errors import WorldError
from sim_bridge.geometry.shapes import Mesh, MeshFile

# Part of the name of what is cached: to be raised when the conversion changes.
CACHE_VERSION = 1


def cache_folder() -> Path:
    """Where converted meshes are kept; it may be deleted at any time."""
    root = os.environ.get("XDG_CACHE_HOME") or str(Path("~/.cache").expanduser())
    return Path(root) / "sim_bridge" / "meshes"


def load_mesh(file: MeshFile, cache: Optional[Path] = None) -> Mesh:
    """The triangles of a mesh file; ``cache``: folder of converted meshes, by default that of the user.

    A COLLADA file's unit is honoured; like Gazebo, its up axis is not. Raises WorldError.
    """
    try:
        content = read_bytes(file.path)
    except OSError as error:
        raise WorldError(f"{file.path}: cannot be read ({error.strerror})") from None
    key = f"{CACHE_VERSION} {file.path.suffix.lower()} {file.submesh} {file.centred} ".encode() + content
    cached = (cache or cache_folder()) / f"{hashlib.sha256(key).hexdigest()}.npz"
    mesh = _read(cached)
    if mesh is None:
        mesh = _convert(file)
        _write(mesh, cached)
    vertices = mesh.vertices * file.scale
    if not np.abs(vertices).max() <= MAX_COORDINATE:
        raise WorldError(f"{file.path}: scaled by {file.scale} it is larger than anything in a world")
    return Mesh(vertices, mesh.triangles, mesh.colours)


def _resolver(path: Path) -> Any:
    """Finds what a mesh names, as pictures, with the limits of any file."""
    from trimesh.resolvers import FilePathResolver

    class Resolver(FilePathResolver):
        def get(self, name: str) -> bytes:
            return read_bytes(Path(self.parent) / name.strip())

    return Resolver(str(path))


def _convert(file: MeshFile) -> Mesh:
    import trimesh

    path, submesh = file.path, file.submesh
    # It logs the whole traceback of every picture that is not there.
    logging.getLogger("trimesh").setLevel(logging.CRITICAL)
    try:
        by_groups = submesh and path.suffix.lower() == ".obj"
        scene: Any = (
            _obj_by_groups(path)
            if by_groups
            else trimesh.load(str(path), force="scene", resolver=_resolver(path))
        )
        parts = [(node, *scene.graph[node]) for node in scene.graph.nodes_geometry]
        chosen = [
            scene.geometry[name].copy().apply_transform(placed)
            for node, placed, name in parts
            if submesh in ("", node, name)
        ]
        if not chosen:
            raise WorldError(f"{path}: holds no mesh" + (f" named {submesh!r}" if submesh else ""))
        return _joined(file, [part for part in chosen if hasattr(part, "faces")])
    except WorldError:
        raise
    except Exception as error:  # the many parsers below trimesh.load share no error class
        raise WorldError(f"{path}: not a readable mesh ({type(error).__name__}: {error})") from None


def _joined(file: MeshFile, chosen: Sequence[Any]) -> Mesh:
    """The parts of a scene that have faces, as one mesh. Raises WorldError if it would be empty."""
    if not chosen:
        raise WorldError(f"{file.path}: holds no triangles")
    colours = np.vstack([_colours(part) for part in chosen])
    unit = float(str(chosen[0].metadata.get("units", "1")).split()[0].replace("meters", "1"))
    offsets = np.cumsum([0, *(len(part.vertices) for part in chosen)])
    vertices = np.vstack([np.asarray(part.vertices, dtype=float) for part in chosen]) * unit
    triangles = np.vstack([part.faces + offset for part, offset in zip(chosen, offsets)])
    if file.centred:
        vertices = vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2.0
    vertices, first = _without_doubles(vertices)
    mesh = Mesh(vertices, first[triangles].astype(np.int32), colours)
    if not _is_whole(mesh):
        raise WorldError(f"{file.path}: holds no triangles, or corners that are not three numbers each")
    return mesh


def _obj_by_groups(path: Path) -> Any:
    """An OBJ file whose parts are its objects and groups; trimesh makes them of its materials, or objects."""
    import trimesh

    text = re.sub(r"^g ", "o ", read_text(path, errors="replace"), flags=re.MULTILINE)
    return trimesh.load(
        io.StringIO(text), file_type="obj", force="scene", group_material=False, skip_materials=True
    )


def _without_doubles(vertices: np.ndarray):
    """The different vertices, and the index among them of each vertex."""
    unique, first = np.unique(vertices.astype(np.float32), axis=0, return_inverse=True)
    return unique.astype(float), first.reshape(-1)


def _colours(part: Any) -> np.ndarray:
    """One colour (M, 3) for each triangle: of the faces, of the material, or the mean of its picture."""
    count = len(part.faces)
    visual = part.visual
    if visual.kind in ("face", "vertex"):
        return np.asarray(visual.face_colors)[:, :3].astype(np.float32) / 255.0
    material = getattr(visual, "material", None)
    picture = getattr(material, "image", None) or getattr(material, "baseColorTexture", None)
    if picture is not None:
        colour = np.asarray(picture.convert("RGB").resize((1, 1))).reshape(3)
    else:
        colour = np.asarray(getattr(material, "main_color", (179, 179, 179)))[:3]
    return np.tile(colour.astype(np.float32) / 255.0, (count, 1))


def _read(cached: Path) -> Optional[Mesh]:
    """None if there is none, or none that is whole: it is made anew then."""
    try:
        arrays = read_arrays(cached)
        mesh = Mesh(arrays["vertices"], arrays["triangles"], arrays["colours"])
    except (OSError, KeyError, ValueError):
        return None
    return mesh if _is_whole(mesh) else None


def _is_whole(mesh: Mesh) -> bool:
    vertices, triangles, colours = mesh.vertices, mesh.triangles, mesh.colours
    return (
        vertices.dtype == np.float64
        and vertices.shape == (len(vertices), 3)
        and bool(np.isfinite(vertices).all())
        and triangles.dtype == np.int32
        and triangles.shape == (len(triangles), 3)
        and len(triangles) > 0
        and bool((triangles >= 0).all() and (triangles < len(vertices)).all())
        and colours is not None
        and colours.dtype == np.float32
        and colours.shape == triangles.shape
    )


def _write(mesh: Mesh, cached: Path) -> None:
    """Beside, then renamed; where nothing can be written nothing is kept."""
    try:
        cached.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=cached.parent, suffix=".npz", delete=False) as beside:
            np.savez(beside, **{key: np.asarray(array) for key, array in vars(mesh).items()})
        Path(beside.name).replace(cached)
    except OSError:
        return
