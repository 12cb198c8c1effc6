"""Which software makes results: the same version, the same results."""

import hashlib
import platform
from functools import lru_cache
from importlib import metadata
from pathlib import Path

SOURCES = Path(__file__).resolve().parents[4]
# What a mission in one process is made of, and the packages that compute in it.
PACKAGES = (
    *("add_markers", "amcl_lite", "home_service", "laboratory", "move_base_lite", "pick_objects"),
    *("planar", "plugin_examples", "sim_bridge", "slam_lite", "supervision"),
)
ENDINGS = (".py", ".yaml", ".urdf", ".xacro")
LIBRARIES = ("numpy", "scipy", "numba", "pybullet")
# Nodes, commands and pages change no result.
LEFT_OUT = ("ros", "test", "commands", "page", "statistics", "campaign", "search", "__pycache__")


@lru_cache(maxsize=1)
def version() -> str:
    """Of all code and parameters that a result depends on, of Python and its numerical packages."""
    digest = hashlib.sha256(platform.python_version().encode())
    for library in LIBRARIES:
        digest.update(f"{library} {metadata.version(library)}".encode())
    for package in PACKAGES:
        folder = SOURCES / package
        for path in sorted(folder.rglob("*")):
            name = path.relative_to(folder)
            if path.suffix in ENDINGS and not set(LEFT_OUT) & set(name.parts):
                digest.update(f"{package}/{name}".encode())
                digest.update(path.read_bytes())
    return digest.hexdigest()[:12]
