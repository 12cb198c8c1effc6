"""Programs and packages that stand in for real ones while a project runs: they come first on its paths."""

from pathlib import Path
from typing import Dict, Mapping

PACKAGE_FOLDER = Path(__file__).resolve().parents[3]
STAND_INS = PACKAGE_FOLDER / "stand_ins"


def without_stand_ins(environment: Mapping[str, str]) -> Dict[str, str]:
    """The environment of a real program, in which each name means the real thing again.

    rviz, for one, finds its plugins by the package of its name.
    """
    hidden = {str(STAND_INS), *(str(STAND_INS / part) for part in ("bin", "lib", "share"))}
    return {
        name: ":".join(entry for entry in value.split(":") if entry not in hidden)
        if str(STAND_INS) in value
        else value
        for name, value in environment.items()
    }
