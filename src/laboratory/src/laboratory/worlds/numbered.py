"""The numbered files that a benchmark's worlds are kept in."""

import re
from pathlib import Path
from typing import Dict

# Folders below the one that is named; beyond that it was not meant.
DEPTH = 3


def numbered_files(folder: Path, stem: str, suffix: str) -> Dict[int, Path]:
    """``<stem>_N<suffix>`` in a folder and not far below it, by N; none if that cannot be looked at."""
    name = re.compile(rf"{stem}_([0-9]{{1,9}}){re.escape(suffix)}")
    patterns = ["*/" * depth + f"{stem}_*{suffix}" for depth in range(DEPTH + 1)]
    try:
        found = [file for pattern in patterns for file in sorted(folder.glob(pattern))]
    except (OSError, ValueError):  # no folder can have that name
        return {}
    matches = ((name.fullmatch(file.name), file) for file in found)
    return {int(match[1]): file for match, file in matches if match}
