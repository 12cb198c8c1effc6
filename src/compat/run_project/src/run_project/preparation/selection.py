"""Selection of the project's packages to build."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Dict, List, Mapping, Set

from run_project.checkout.vendored import is_vendored

_COMPILED = re.compile(
    r"^\s*(?:add_executable|add_library|cuda_add_\w+|generate_messages)\s*\(", re.MULTILINE | re.IGNORECASE
)
_COMPONENTS = re.compile(r"find_package\s*\(\s*catkin\b([^)]*)\)", re.IGNORECASE)
_WORDS_OF_CMAKE = {"REQUIRED", "COMPONENTS", "QUIET", "OPTIONAL_COMPONENTS"}
_FIND = re.compile(r"\$\(find\s+([\w-]+)\)")


@dataclass(frozen=True)
class PackageSelection:
    """Packages of a project that are not built as they are.

    Attributes:
        replaced: Package that is not built but completed with the files of this workspace's -> reason.
        without_parts: Those of them whose robots need packages that are not installed.
        unbuilt: Package of which only files, as launch files and worlds, are used -> reason.
        absent: Dependency that is not installed -> packages that declare it.
    """

    replaced: Dict[str, str]
    without_parts: Set[str]
    unbuilt: Dict[str, str]
    absent: Dict[str, List[str]]

    def names(self) -> List[str]:
        """Return the names in it, always in one order."""
        parts = (self.replaced, self.without_parts, self.unbuilt, self.absent)
        return [" ".join(sorted(part)) for part in parts]


def select_packages(
    folders: Mapping[str, Path], stand_ins: Mapping[str, Path], is_installed: Callable[[str], bool]
) -> PackageSelection:
    """Select the packages to build.

    Args:
        folders: Package name -> folder, of the project.
        stand_ins: Package name -> folder, of this workspace's replacements for official packages.
        is_installed: Whether catkin finds a package outside of the project.
    """
    replaced: Dict[str, str] = {}
    without_parts: Set[str] = set()
    unbuilt: Dict[str, str] = {}
    absent: Dict[str, List[str]] = {}
    for name, folder in sorted(folders.items()):
        cmake = _read(folder / "CMakeLists.txt")
        is_compiled = bool(_COMPILED.search(cmake))
        lost_parts = sorted(
            other for other in _found_in_xacro(folder) if other not in folders and not is_installed(other)
        )
        if name in stand_ins and lost_parts:
            replaced[name] = f"its robots need {', '.join(lost_parts)}, which is not installed"
            without_parts.add(name)
        elif name in stand_ins and is_compiled and _has_nodes_or_messages(stand_ins[name]):
            replaced[name] = "its sources do not build with current libraries"
        elif is_compiled and is_vendored(name):
            unbuilt[name] = "its sources do not build with current libraries; not needed in simulation"
        else:
            for other in sorted(_components(cmake) - set(folders)):
                if not is_installed(other):
                    absent.setdefault(other, []).append(name)
    return PackageSelection(replaced, without_parts, unbuilt, absent)


def _has_nodes_or_messages(stand_in: Path) -> bool:
    return any((stand_in / part).is_dir() for part in ("nodes", "msg"))


def _components(cmake: str) -> Set[str]:
    text = " ".join(_COMPONENTS.findall(cmake))
    return {word for word in text.split() if re.fullmatch(r"[a-z]\w*", word) and word not in _WORDS_OF_CMAKE}


def _found_in_xacro(folder: Path) -> Set[str]:
    return {name for file in sorted(folder.rglob("*.xacro")) for name in _FIND.findall(_read(file))}


def _read(file: Path) -> str:
    """Text of a file without CMake comments; empty if it cannot be read."""
    try:
        return re.sub(r"#.*", "", file.read_text(errors="replace"))
    except OSError:
        return ""
