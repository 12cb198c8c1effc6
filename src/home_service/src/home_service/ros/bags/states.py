"""What the nodes that play bags are told and tell alike."""

import os
from pathlib import Path
from typing import List

from planar import SettingsError

PLAYING, ENDED, BROKEN = "playing", "ended", "broken: "
"""What is told on ``~state``; the last with why, as far as the text goes."""


def bags_of(text: str) -> List[Path]:
    """The bags that ``~bags`` names. Raises SettingsError."""
    if not text:
        raise SettingsError(f"~bags must name bags, separated by '{os.pathsep}'")
    return [Path(name) for name in text.split(os.pathsep)]
