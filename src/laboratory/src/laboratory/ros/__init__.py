"""Scenarios over the graph of nodes, and the packages of official nodes."""

from pathlib import Path

import rospkg

from planar import SettingsError

# Packages of this project that carry the names of official packages.
_COMPAT = Path(__file__).resolve().parents[4] / "compat"


def official_package(name: str, option: str) -> str:
    """Return the package of an official node: ``name``.

    Args:
        name: Package and node.
        option: What asks for it, such as ``planner``, for the error.

    Raises:
        SettingsError: It is not installed.
    """
    try:
        path = Path(rospkg.RosPack().get_path(name))
    except rospkg.ResourceNotFound:
        path = _COMPAT
    if _COMPAT in (path.resolve(), *path.resolve().parents):
        raise SettingsError(
            f"{option} official: the official {name} is not installed; install it, or put it into src/"
        )
    return name
