"""Which software made a run."""

import platform
import subprocess
import xml.etree.ElementTree as ElementTree
from importlib import metadata
from pathlib import Path
from typing import Dict


def versions() -> Dict[str, str]:
    """Names to versions of what determines how a run goes."""
    found = {"python": platform.python_version(), "home_service": project_version()}
    for package in ("numpy", "scipy", "numba", "pybullet"):
        found[package] = metadata.version(package)
    distribution = subprocess.run(
        ["rosversion", "-d"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False
    )
    found["ros"] = distribution.stdout.strip() or "unknown"
    return found


def project_version() -> str:
    """The version in this package.xml, as in those of the project's other packages."""
    package_xml = Path(__file__).resolve().parents[2] / "package.xml"
    return ElementTree.parse(package_xml).findtext("version", "unknown")
