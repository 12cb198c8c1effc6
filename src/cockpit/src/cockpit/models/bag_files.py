"""Bag files: a path for a new one, and those in a folder."""

import re
from pathlib import Path
from typing import List

from cockpit.errors import CockpitError

NAME = re.compile(r"[\w.+-]{1,80}")
# Relative to the working folder of the cockpit: its recordings, and those of runs.
PLACES = ("*.bag", "runs/*/bag/*.bag")
MOST_LISTED = 100


def new_bag(folder: Path, name: str) -> Path:
    """Return the path of a new bag.

    Args:
        folder: Folder of the bag.
        name: File name, with or without ``.bag``.

    Raises:
        CockpitError: The name is not valid, or the file exists.
    """
    stem = name.strip()
    stem = stem[:-4] if stem.endswith(".bag") else stem
    if not NAME.fullmatch(stem) or stem.startswith("."):
        raise CockpitError(f"'{name}' is not a valid file name: use letters, digits, '-', '_', '+' and '.'")
    path = folder / f"{stem}.bag"
    if path.exists() or path.with_suffix(".bag.active").exists():
        raise CockpitError(f"{path} exists already; choose another name")
    return path


def bags_below(folder: Path) -> List[str]:
    """Return the paths of bags relative to ``folder``, the newest first."""
    found = [path for pattern in PLACES for path in folder.glob(pattern) if path.is_file()]
    found.sort(key=lambda path: path.stat().st_mtime, reverse=True)
    return [str(path.relative_to(folder)) for path in found[:MOST_LISTED]]
