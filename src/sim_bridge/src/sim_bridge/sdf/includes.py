"""Where the files are that an SDF file refers to."""

import os
from pathlib import Path
from typing import Optional, Sequence
from urllib.parse import ParseResult, unquote, urlparse

from planar.files.reading import exists, read_bytes
from sim_bridge.errors import WorldError
from sim_bridge.sdf.element import parse_text, version_of


def resolve(uri: str, beside: Path, model_folders: Sequence[Path]) -> Optional[Path]:
    """The existing file or folder that ``uri`` names, or None.

    ``model://name/...`` is looked up in ``model_folders``, and leads out of none. ``file://`` and plain
    paths are absolute, or relative to the folder ``beside`` and then to the model folders, as Gazebo does.
    """
    parts = parts_of(uri)
    if parts is None:
        return None
    path = Path(unquote(parts.netloc + parts.path))
    if parts.scheme == "model":
        leads_out = ".." in Path(os.path.normpath(path)).parts
        candidates = [] if leads_out else [folder / path for folder in model_folders]
    elif parts.scheme in ("", "file"):
        candidates = [beside / path, *(folder / path for folder in model_folders)]
    else:
        candidates = []
    return next((candidate for candidate in candidates if exists(candidate)), None)


def parts_of(uri: str) -> Optional[ParseResult]:
    """Its scheme, its host and its path; None if it is no URI."""
    try:
        return urlparse(uri)
    except ValueError:
        return None


def has_model(path: Path) -> bool:
    """Whether that is an SDF file or the folder of a model."""
    return path.is_file() or (path / "model.config").is_file()


def model_file(folder: Path) -> Path:
    """The newest SDF file that a model folder's ``model.config`` names. Raises WorldError."""
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
