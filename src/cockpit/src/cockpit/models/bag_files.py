"""Where recordings go, and which there are."""

import re
from pathlib import Path
from typing import List

from cockpit.errors import CockpitError

NAME = re.compile(r"[\w.+-]{1,80}")
# Below the folder that the cockpit was started in: its own recordings, and those of runs.
PLACES = ("*.bag", "runs/*/bag/*.bag")
MOST_LISTED = 100


def new_bag(folder: Path, name: str) -> Path:
    """A file that is not there yet. Raises CockpitError."""
    stem = name.strip()
    stem = stem[:-4] if stem.endswith(".bag") else stem
    if not NAME.fullmatch(stem) or stem.startswith("."):
        raise CockpitError(f"'{name}' is no name of a file: letters, digits, '-', '_', '+' and '.' are")
    path = folder / f"{stem}.bag"
    if path.exists() or path.with_suffix(".bag.active").exists():
        raise CockpitError(f"{path} is there already")
    return path


def bags_below(folder: Path) -> List[str]:
    """As they are named from ``folder``, the newest first."""
    found = [path for pattern in PLACES for path in folder.glob(pattern) if path.is_file()]
    found.sort(key=lambda path: path.stat().st_mtime, reverse=True)
    return [str(path.relative_to(folder)) for path in found[:MOST_LISTED]]
