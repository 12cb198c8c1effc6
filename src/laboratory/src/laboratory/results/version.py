"""Version of the software that computes results: equal versions give equal results."""

import hashlib
import platform
from functools import lru_cache
from importlib import metadata
from pathlib import Path
from typing import Any, Sequence

SOURCES = Path(__file__).resolve().parents[4]
# Packages that compute the result of a run in one process, and third-party packages that do.
PACKAGES = (
    *("add_markers", "amcl_lite", "home_service", "laboratory", "move_base_lite", "pick_objects"),
    *("planar", "plugin_examples", "sim_bridge", "slam_lite", "supervision"),
)
PACKAGES_OVER_ROS = ("home_service_msgs", "map_lite", "planar_ros", "rospy_transport", "sim_bridge_msgs")
ENDINGS = (".py", ".yaml", ".urdf", ".xacro")
ENDINGS_OVER_ROS = (".launch", ".msg", ".srv", ".action")
LIBRARIES = ("numpy", "scipy", "numba", "pybullet")
# Folders that do not influence results.
LEFT_OUT = ("ros", "test", "commands", "page", "statistics", "campaign", "search", "__pycache__")


@lru_cache(maxsize=1)
def version() -> str:
    """Return a hash of the code and parameters of a run, of Python and of the numerical packages."""
    digest = hashlib.sha256(platform.python_version().encode())
    for library in LIBRARIES:
        digest.update(f"{library} {metadata.version(library)}".encode())
    _feed(digest, PACKAGES, ENDINGS, LEFT_OUT)
    return digest.hexdigest()[:12]


@lru_cache(maxsize=1)
def version_over_ros() -> str:
    """Return a hash that also covers the nodes, launch files and message definitions."""
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
