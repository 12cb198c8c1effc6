"""Scenarios over the graph of nodes, and the package of the official move_base."""

from pathlib import Path

import rospkg

from planar import SettingsError

NAME = "move_base"
# Packages that have the names of official ones, for projects that ask for them.
_OURS = Path(__file__).resolve().parents[4] / "compat"


def official_move_base() -> str:
    """The name of its package. Raises SettingsError if there is none but ours of that name."""
    try:
        path = Path(rospkg.RosPack().get_path(NAME))
    except rospkg.ResourceNotFound:
        path = _OURS
    if _OURS in (path.resolve(), *path.resolve().parents):
        raise SettingsError(
            "planner official: the official move_base is not there: install it, or put it into src/"
        )
    return NAME
