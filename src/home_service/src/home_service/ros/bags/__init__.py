"""Nodes and processes that record and play bags; states that both players publish on ``~state``."""

import os
from pathlib import Path
from typing import List

from planar import SettingsError

PLAYING, ENDED = "playing", "ended"
# Followed by the reason.
BROKEN = "broken: "


def bags_of(text: str) -> List[Path]:
    """Split the parameter ``~bags`` into paths.

    Raises:
        SettingsError: If it names no bag.
    """
    if not text:
        raise SettingsError(f"~bags is empty: set it to paths of bags separated by '{os.pathsep}'")
    return [Path(name) for name in text.split(os.pathsep)]
