"""Loads meshes from COLLADA, STL and OBJ files, with a cache of converted ones."""

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

# Part of the names of cached files; increase it when the conversion changes.
CACHE_VERSION = 1


def cache_folder() -> Path:
    """Return the folder of converted meshes, which may be deleted at any time."""
    root = os.environ.get("XDG_CACHE_HOME") or str(Path("~/.cache").expanduser())
    return Path(root) / "sim_bridge" / "meshes"


def load_mesh(file: MeshFile, cache: Optional[Path] = None) -> Mesh:
    """Load a mesh file.

    The unit of a COLLADA file is applied; its up axis is ignored, as in Gazebo.

    Args:
        file: The file, with scale and submesh.
        cache: Folder of converted meshes, by default ``cache_folder()``.

    Returns:
        The triangles, scaled, in metres.

    Raises:
        WorldError: The file cannot be read or contains no triangles.
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
        raise WorldError(f"{file.path}: scaled by {file.scale} it exceeds {MAX_COORDINATE:g} m")
    return Mesh(vertices, mesh.triangles, mesh.colours)


def _resolver(path: Path) -> Any:
    """Return a resolver of the files that a mesh refers to, e.g. textures, with our limits on files."""
    from trimesh.resolvers import FilePathResolver

    class Resolver(FilePathResolver):
        def get(self, name: str) -> bytes:
            return read_bytes(Path(self.parent) / name.strip())

    return Resolver(str(path))


def _convert(file: MeshFile) -> Mesh:
    import trimesh

    path, submesh = file.path, file.submesh
    # It logs a whole traceback for each missing texture.
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
        return _join(file, [part for part in chosen if hasattr(part, "faces")])
    except WorldError:
        raise
    except Exception as error:  # the parsers below trimesh.load share no error class
        raise WorldError(f"{path}: not a readable mesh ({type(error).__name__}: {error})") from None


def _join(file: MeshFile, chosen: Sequence[Any]) -> Mesh:
    """Join parts of a scene into one mesh. Raises WorldError if it would be empty."""
    if not chosen:
        raise WorldError(f"{file.path}: holds no triangles")
    colours = np.vstack([_colours(part) for part in chosen])
    unit = float(str(chosen[0].metadata.get("units", "1")).split()[0].replace("meters", "1"))
    offsets = np.cumsum([0, *(len(part.vertices) for part in chosen)])
    vertices = np.vstack([np.asarray(part.vertices, dtype=float) for part in chosen]) * unit
    triangles = np.vstack([part.faces + offset for part, offset in zip(chosen, offsets)])
    if file.centred:
        vertices = vertices - (vertices.min(axis=0) + vertices.max(axis=0)) / 2.0
    vertices, first = _unique_vertices(vertices)
    mesh = Mesh(vertices, first[triangles].astype(np.int32), colours)
    if not _is_valid(mesh):
        raise WorldError(f"{file.path}: holds no triangles, or corners that are not three numbers each")
    return mesh


def _obj_by_groups(path: Path) -> Any:
    """Load an OBJ file by objects and groups; trimesh alone splits it by materials or objects."""
    import trimesh

    text = re.sub(r"^g ", "o ", read_text(path, errors="replace"), flags=re.MULTILINE)
    return trimesh.load(
        io.StringIO(text), file_type="obj", force="scene", group_material=False, skip_materials=True
    )


def _unique_vertices(vertices: np.ndarray):
    """Return the distinct vertices, and for each vertex its index among them."""
    unique, first = np.unique(vertices.astype(np.float32), axis=0, return_inverse=True)
    return unique.astype(float), first.reshape(-1)


def _colours(part: Any) -> np.ndarray:
    """Return one colour (M, 3) per triangle: of the faces, the material, or the mean of the texture."""
    count = len(part.faces)
    visual = part.visual
    if visual.kind in ("face", "vertex"):
        return np.asarray(visual.face_colors)[:, :3].astype(np.float32) / 255.0
    material = getattr(visual, "material", None)
    texture = getattr(material, "image", None) or getattr(material, "baseColorTexture", None)
    if texture is not None:
        colour = np.asarray(texture.convert("RGB").resize((1, 1))).reshape(3)
    else:
        colour = np.asarray(getattr(material, "main_color", (179, 179, 179)))[:3]
    return np.tile(colour.astype(np.float32) / 255.0, (count, 1))


def _read(cached: Path) -> Optional[Mesh]:
    """Return a cached mesh, None if there is no valid one."""
    try:
        arrays = read_arrays(cached)
        mesh = Mesh(arrays["vertices"], arrays["triangles"], arrays["colours"])
    except (OSError, KeyError, ValueError):
        return None
    return mesh if _is_valid(mesh) else None


def _is_valid(mesh: Mesh) -> bool:
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
    """Write a mesh to the cache, atomically; do nothing if the folder cannot be written."""
    try:
        cached.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=cached.parent, suffix=".npz", delete=False) as temporary:
            np.savez(temporary, **{key: np.asarray(array) for key, array in vars(mesh).items()})
        Path(temporary.name).replace(cached)
    except OSError:
        return
