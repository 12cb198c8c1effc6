#!/usr/bin/env python3
"""Count mentions of the private parts of rospy, viser and websockets, by file.

python3 tests/repository/private_parts.py [ROOT]
"""

import argparse
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterator, Tuple

ROOT = Path(__file__).resolve().parents[2]
# This check and its test name them.
LEFT_OUT = ("tests/repository/private_parts.py", "tests/repository/test_private_parts.py")


@dataclass(frozen=True)
class Library:
    """Private parts of a library, and where they may be mentioned.

    Attributes:
        name: Name of the library.
        pattern: Matches one mention.
        allowed: Files, or folders with a slash at the end, that hold every access.
        most_files: Number of files in ``allowed`` that may mention them, tests not counted.
    """

    name: str
    pattern: "re.Pattern[str]"
    allowed: Tuple[str, ...]
    most_files: int


# Public are the names that ``import rospy`` provides, and rospy.numpy_msg.
_ROSPY_MODULES = (
    "client|core|exceptions|impl|msg|msproxy|names|registration|rosconsole|rostime|service|timer|topics"
)
LIBRARIES = (
    Library(
        "rospy",
        re.compile(
            rf"\brospy\.(?:{_ROSPY_MODULES})\b"
            rf"|\bfrom rospy import [^\n]*\b(?:{_ROSPY_MODULES})\b"
            r"|\brospy\._\w+|\.impl\b"
            r"|\b_(?:Publisher|Subscriber|Topic)Impl\b|\b_TopicManager\b|\bServiceImpl\b"
            r"|\bQueuedConnection\b|\bTCPROS[A-Z]\w+|\bTCPServer\b|\bRegManager\b"
            r"|\bget_(?:topic_manager|service_manager|param_server_cache|tcpros_handler)\b"
            r"|\bcallerid_pub\b|\bendpoint_id\b|\brecv_data_class\b|\bstat_num_msg\b|\bstat_bytes\b"
        ),
        ("src/rospy_transport/",),
        3,
    ),
    Library(
        "viser, websockets",
        re.compile(
            r"\bviser\._(?!_)\w+|\bfrom viser import _\w+|\bfrom viser\._\w+|\._gui_\w+"
            r"|\bwebsockets\.asyncio\b|\bServerConnection\b"
        ),
        ("src/cockpit/src/cockpit/page/server_hooks.py", "src/cockpit/test/test_server_hooks.py"),
        1,
    ),
)


def programs(root: Path) -> Iterator[Path]:
    """Yield the Python files of a tree, those without a suffix among them."""
    for folder in ("src", "tests", "scripts", "docs"):
        for path in sorted((root / folder).rglob("*")):
            if path.is_file() and (path.suffix == ".py" or (not path.suffix and _is_python(path))):
                yield path


def mentions(root: Path, library: Library) -> Dict[str, int]:
    """Return the number of mentions by file, relative to the root, where there are any."""
    counts = {
        str(path.relative_to(root)): len(library.pattern.findall(path.read_text(encoding="utf-8")))
        for path in programs(root)
    }
    return {name: count for name, count in counts.items() if count and name not in LEFT_OUT}


def is_allowed(name: str, library: Library) -> bool:
    """Return whether a file may mention the private parts."""
    return any(name == place or (place[-1] == "/" and name.startswith(place)) for place in library.allowed)


def _is_python(path: Path) -> bool:
    with path.open("rb") as file:
        first = file.readline(80)
    return first.startswith(b"#!") and b"python" in first


def main() -> None:
    """Print the counts of a tree."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("root", nargs="?", type=Path, default=ROOT)
    root = parser.parse_args().root
    for library in LIBRARIES:
        found = mentions(root, library)
        outside = {name: count for name, count in found.items() if not is_allowed(name, library)}
        print(f"{library.name}: {sum(found.values())} mentions in {len(found)} files")
        print(f"  outside {', '.join(library.allowed)}: {sum(outside.values())} in {len(outside)} files")
        for name, count in sorted(found.items(), key=lambda item: -item[1]):
            print(f"  {count:4d}  {name}")


if __name__ == "__main__":
    main()
