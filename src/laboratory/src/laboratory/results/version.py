"""Version of the software that computes results: equal versions give equal results."""

import hashlib
import platform
from functools import lru_cache
from importlib import metadata
from pathlib import Path
from typing import Any, List, Sequence, Set
from xml.etree import ElementTree

from laboratory.plugin_files import DATA_SUFFIXES

SOURCES = Path(__file__).resolve().parents[4]
# Their code and that of their dependencies computes results; scenarios name planners of the second.
ROOTS = ("laboratory", "plugin_examples")
# Packages that only show runs.
DISPLAYS = ("cockpit", "run_report")
ENDINGS = (".py", ".urdf", ".xacro", *DATA_SUFFIXES)
ENDINGS_OVER_ROS = (".launch", ".msg", ".srv", ".action")
DEPENDENCIES = ("depend", "exec_depend")
LIBRARIES = ("numpy", "scipy", "numba", "pybullet")
# Folders that do not influence results, in one process.
LEFT_OUT = (
    "ros",
    "planar_ros",
    "rospy_transport",
    "test",
    "commands",
    "page",
    "statistics",
    "campaign",
    "search",
    "__pycache__",
)


@lru_cache(maxsize=1)
def version() -> str:
    """Return a hash of the code and parameters of a run, of Python and of the numerical packages."""
    digest = hashlib.sha256(platform.python_version().encode())
    for library in LIBRARIES:
        digest.update(f"{library} {metadata.version(library)}".encode())
    _feed(digest, ENDINGS, LEFT_OUT)
    return digest.hexdigest()[:12]


@lru_cache(maxsize=1)
def version_over_ros() -> str:
    """Return a hash that also covers the nodes, launch files and message definitions."""
    digest = hashlib.sha256()
    _feed(digest, (*ENDINGS, *ENDINGS_OVER_ROS), ("test", "__pycache__"))
    return digest.hexdigest()[:12]


def packages() -> List[str]:
    """Return the packages in src/ that compute results: those of ROOTS and all that these depend on."""
    found: Set[str] = set(DISPLAYS)
    waiting = list(ROOTS)
    while waiting:
        package = waiting.pop()
        description = SOURCES / package / "package.xml"
        if package not in found and description.is_file():
            found.add(package)
            elements = ElementTree.parse(description).getroot()
            waiting += [str(element.text) for kind in DEPENDENCIES for element in elements.iter(kind)]
    return sorted(found - set(DISPLAYS))


def _feed(digest: Any, endings: Sequence[str], left_out: Sequence[str]) -> None:
    for package in packages():
        folder = SOURCES / package
        for path in sorted(folder.rglob("*")):
            name = path.relative_to(SOURCES)
            if path.suffix in endings and not set(left_out) & set(name.parts):
                digest.update(str(name).encode())
                digest.update(path.read_bytes())
