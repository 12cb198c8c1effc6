"""Which software makes results: the same version, the same results."""

import hashlib
import platform
from functools import lru_cache
from importlib import metadata
from pathlib import Path
from typing import Any, Sequence

SOURCES = Path(__file__).resolve().parents[4]
# What a mission in one process is made of, and the packages that compute in it.
PACKAGES = (
    *("add_markers", "amcl_lite", "home_service", "laboratory", "move_base_lite", "pick_objects"),
    *("planar", "plugin_examples", "sim_bridge", "slam_lite", "supervision"),
)
PACKAGES_OVER_ROS = ("home_service_msgs", "map_lite", "planar_ros", "sim_bridge_msgs")
ENDINGS = (".py", ".yaml", ".urdf", ".xacro")
ENDINGS_OVER_ROS = (".launch", ".msg", ".srv", ".action")
LIBRARIES = ("numpy", "scipy", "numba", "pybullet")
# Nodes, commands and pages change no result.
LEFT_OUT = ("ros", "test", "commands", "page", "statistics", "campaign", "search", "__pycache__")


@lru_cache(maxsize=1)
def version() -> str:
    """Of all code and parameters that a result depends on, of Python and its numerical packages."""
    digest = hashlib.sha256(platform.python_version().encode())
    for library in LIBRARIES:
        digest.update(f"{library} {metadata.version(library)}".encode())
    _feed(digest, PACKAGES, ENDINGS, LEFT_OUT)
    return digest.hexdigest()[:12]


@lru_cache(maxsize=1)
def version_over_ros() -> str:
    """Of what nodes add to that."""
    digest = hashlib.sha256()
    _feed(digest, (*PACKAGES, *PACKAGES_OVER_ROS), (*ENDINGS, *ENDINGS_OVER_ROS), ("test", "__pycache__"))
    return digest.hexdigest()[:12]


def _feed(digest: Any, packages: Sequence[str], endings: Sequence[str], left_out: Sequence[str]) -> None:
    for package in packages:
        folder = SOURCES / package
        for path in sorted(folder.rglob("*")):
            name = path.relative_to(folder)
            if path.suffix in endings and not set(left_out) & set(name.parts):
                digest.update(f"{package}/{name}".encode())
                digest.update(path.read_bytes())
