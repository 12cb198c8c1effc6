"""Programs and packages that replace the terminal emulator, rviz and nodelet while a project runs.

Their folders come first in PATH, ROS_PACKAGE_PATH and CMAKE_PREFIX_PATH.
"""

from pathlib import Path
from typing import Dict, Mapping

PACKAGE_FOLDER = Path(__file__).resolve().parents[3]
STAND_INS = PACKAGE_FOLDER / "stand_ins"


def is_of_workspace(file: str) -> bool:
    """Whether an absolute path is that of a file of this workspace's packages for projects."""
    return file.startswith(f"{PACKAGE_FOLDER.parent}/")


def without_stand_ins(environment: Mapping[str, str]) -> Dict[str, str]:
    """Environment for a real program, without the folders of the stand-ins.

    The real rviz, for example, finds its plugins through the package ``rviz``.
    """
    hidden = {str(STAND_INS), *(str(STAND_INS / part) for part in ("bin", "lib", "share"))}
    return {
        name: ":".join(entry for entry in value.split(":") if entry not in hidden)
        if str(STAND_INS) in value
        else value
        for name, value in environment.items()
    }
