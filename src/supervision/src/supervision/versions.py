"""Versions of the software that determines how a run goes, and the processor."""

import os
import platform
import subprocess
import xml.etree.ElementTree as ElementTree
from datetime import date
from importlib import metadata
from pathlib import Path
from typing import Dict

CPUINFO = Path("/proc/cpuinfo")
# Fields of /proc/cpuinfo on x86 and ARM, with the prefix of each in the result.
KINDS = {
    "model name": "",
    "cpu family": "family ",
    "model": "model ",
    "CPU implementer": "implementer ",
    "CPU part": "part ",
}
VECTOR_UNITS = ("avx512f", "avx2", "avx", "sve", "asimd")


def versions() -> Dict[str, str]:
    """Return names and versions."""
    found = {"python": platform.python_version(), "home_service": project_version()}
    for package in ("numpy", "scipy", "numba", "pybullet"):
        found[package] = metadata.version(package)
    distribution = subprocess.run(
        ["rosversion", "-d"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False
    )
    found["ros"] = distribution.stdout.strip() or "unknown"
    found["processor"] = processor()
    return found


def processor(cpuinfo: Path = CPUINFO) -> str:
    """Return the model of the first processor and its widest vector unit, which numpy and numba use."""
    try:
        first_entry = cpuinfo.read_text(encoding="utf-8", errors="replace").split("\n\n")[0]
    except OSError:
        return "unknown"
    lines = [line.partition(":") for line in first_entry.splitlines()]
    facts = {key.strip(): value.strip() for key, _, value in lines}
    units = facts.get("flags", facts.get("Features", "")).split()
    kind = [before + facts[key] for key, before in KINDS.items() if facts.get(key)]
    return " ".join([*kind, *[unit for unit in VECTOR_UNITS if unit in units][:1]]) or "unknown"


def project_version() -> str:
    """Return the version in this package.xml, which is the same in all packages of the project."""
    package_xml = Path(__file__).resolve().parents[2] / "package.xml"
    return ElementTree.parse(package_xml).findtext("version", "unknown")


def provenance(today: date) -> str:
    """Return date, commit and machine of a measurement, as items of a Markdown list."""
    command = ["git", "-C", str(Path(__file__).parent), "rev-parse", "--short", "HEAD"]
    git = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
    commit = git.stdout.strip() or f"version {project_version()}"
    return (
        f"* Date and commit: {today.isoformat()}, {commit}\n* Machine: {processor()}, {os.cpu_count()} cores"
    )
