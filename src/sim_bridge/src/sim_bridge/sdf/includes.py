"""Finds the files that an SDF file refers to."""

import os
from pathlib import Path
from typing import Optional, Sequence
from urllib.parse import ParseResult, unquote, urlparse

from planar.files.reading import exists, read_bytes
from sim_bridge.errors import WorldError
from sim_bridge.sdf.document import version_of
from sim_bridge.sdf.element import parse_text


def resolve(uri: str, beside: Path, model_folders: Sequence[Path]) -> Optional[Path]:
    """Return the existing file or folder that a URI names, None if there is none.

    Args:
        uri: ``model://name/...``, which is searched in the model folders and cannot leave them, or ``file://``
            or a plain path, which is absolute, or relative to ``beside`` and then to the model folders.
        beside: Folder of the file that holds the URI.
        model_folders: Folders of models (GAZEBO_MODEL_PATH).
    """
    parts = parts_of(uri)
    if parts is None:
        return None
    path = Path(unquote(parts.netloc + parts.path))
    if parts.scheme == "model":
        leaves_folder = ".." in Path(os.path.normpath(path)).parts
        candidates = [] if leaves_folder else [folder / path for folder in model_folders]
    elif parts.scheme in ("", "file"):
        candidates = [beside / path, *(folder / path for folder in model_folders)]
    else:
        candidates = []
    return next((candidate for candidate in candidates if exists(candidate)), None)


def parts_of(uri: str) -> Optional[ParseResult]:
    """Return the parts of a URI, None if it is not valid."""
    try:
        return urlparse(uri)
    except ValueError:
        return None


def has_model(path: Path) -> bool:
    """Return whether a path is an SDF file or a model folder."""
    return path.is_file() or (path / "model.config").is_file()


def model_file(folder: Path) -> Path:
    """Return the SDF file of the newest version in a model folder's ``model.config``.

    Raises:
        WorldError: ``model.config`` cannot be read or names no SDF file.
    """
    if folder.is_file():
        return folder
    config_path = folder / "model.config"
    try:
        config = parse_text(read_bytes(config_path), str(config_path), roots=("model",))
    except OSError as error:
        raise WorldError(f"{config_path}: cannot be read ({error.strerror})") from None
    versions = [(version_of(sdf.attribute("version")), sdf.text) for sdf in config.children("sdf")]
    if not versions:
        raise WorldError(f"{config_path}: names no <sdf> file")
    return folder / max(versions)[1]
