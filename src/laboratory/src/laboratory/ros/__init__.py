"""Scenarios over the graph of nodes, and the package of the official move_base."""

from pathlib import Path

import rospkg

from planar import SettingsError

NAME = "move_base"
# Packages of this project that carry the names of official packages.
_COMPAT = Path(__file__).resolve().parents[4] / "compat"


def official_move_base() -> str:
    """Return the package of the official move_base. Raises SettingsError if it is not installed."""
    try:
        path = Path(rospkg.RosPack().get_path(NAME))
    except rospkg.ResourceNotFound:
        path = _COMPAT
    if _COMPAT in (path.resolve(), *path.resolve().parents):
        raise SettingsError(
            "planner official: the official move_base is not installed; install it, or put it into src/"
        )
    return NAME
