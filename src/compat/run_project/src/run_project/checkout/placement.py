"""Placement of a checkout: its folder in the workspace, the script's start folder, and the paths to mount.

Authors start scripts from the workspace, from the script's folder or from the repository, which is cloned as
the ``src`` of a workspace or into it, below another home folder. All combinations are compared; the one with
most of the referenced files is selected.
"""

import os
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Dict, FrozenSet, Iterable, Iterator, List, Mapping, Optional, Pattern, Set, Tuple

from run_project.checkout.layout import Checkout, CheckoutKind

# Top folders of the system, and names that rather are the tail of a path: nothing is mounted there.
SYSTEM_FOLDERS = frozenset("bin boot dev etc lib lib64 opt proc run sbin src sys usr var".split())
BUILD_PRODUCTS = ("devel/setup.bash", "devel/setup.sh", "devel/setup.zsh", "build", "install/setup.bash")
READ_SUFFIXES = frozenset(
    ".bash .cpp .h .launch .py .rviz .sdf .sh .urdf .world .xacro .xml .yaml .yml".split()
)

# Placeholder for the folder in which the workspace is created.
ROOT = "/@"
# A folder deeper below ROOT than any number of ``..`` in a script.
DEEP_FOLDER = ROOT + "/_" * 20

_NAME = r"[\w@%+.-]+"
_ABSOLUTE = re.compile(rf"(?<![\w}})~.:/-])((?:/{_NAME})+)")
_HOME = re.compile(r"(?<![\w})~.:/-])(?:~|\$HOME|\$\{HOME\})(?=/)")
_ASSIGNMENT = re.compile(r"^\s*(?:export\s+|readonly\s+)?(\w+)=(\"[^\"]*\"|'[^']*'|[^\s;&]*)")
_SCRIPT_FOLDER = re.compile(r"[$`(]+\s*dirname\s+[\"']?\$\{?(?:0|BASH_SOURCE(?:\[0\])?)\}?[\"']?\s*[)`]")
_CD_PWD = re.compile(
    r"\$\(\s*cd\s+(?:-P\s+)?(?:--\s+)?[\"']?([^\"'\s;&>]+)[\"']?[^()]*?(?:&&|;)\s*pwd(?:\s+-P)?\s*\)"
)
_WORKING_FOLDER = re.compile(r"\$\(\s*pwd\s*\)|`\s*pwd\s*`|\$PWD\b|\$\{PWD\}")
_ROSPACK = re.compile(r"(?:\$\(\s*rospack\s+find\s+([\w-]+)\s*\)|`\s*rospack\s+find\s+([\w-]+)\s*`)")
_CD = re.compile(r"(?:^|[;&(\"'\s])cd\s+[\"']?([^\s;&\"')]+)")
# A quoted part of a path that continues after the quotes: "$PWD"/src.
_QUOTED_PIECE = re.compile(r"([\"'])([^\"'\s]*)\1(?=/)")
_PATH = re.compile(r"[^\s\"'`;&|()<>=,]*/[^\s\"'`;&|()<>=,]*|(?<=:=)[^\s\"';&]+")


@dataclass(frozen=True)
class Placement:
    """Where a checkout is copied and started.

    Paths are relative to the folder in which the workspace is created.

    Attributes:
        checkout: Folder of the checkout.
        workspace: Folder of the catkin workspace.
        start: Folder in which the script is started.
        mounts: Absolute path referenced by the project -> folder or file to be mounted there.
        links: Referenced file that does not exist -> file of the same name elsewhere in the checkout.
    """

    checkout: Path
    workspace: Path
    start: Path
    mounts: Dict[str, Path]
    links: Dict[Path, Path] = field(default_factory=dict)


def best_placement(
    checkout: Checkout, script: str, texts: Mapping[str, str], home: str, user: str
) -> Placement:
    """Select the placement under which most of the referenced files exist.

    Args:
        checkout: The project.
        script: The script to run, relative to the checkout.
        texts: Contents of files by path relative to the checkout, including the script.
        home: Home folder that ``~`` and ``$HOME`` stand for.
        user: User name that ``$USER`` stands for.
    """
    named = _external_paths(checkout, script, texts, home, user)
    files = _with_parent_folders(checkout.files)
    prefixes = sorted(
        {prefix for prefix in (_checkout_prefix(path, files) for path in named) if prefix is not None}
    )
    best: Optional[Tuple[Tuple[int, int], Placement]] = None
    for at, workspace in _candidate_positions(checkout, [prefix for prefix, _ in prefixes]):
        mounts = dict(_mounts(prefixes, at, workspace))
        there = _existing_paths(checkout, at, workspace)
        packages = {name: _in_root(at / folder) for name, folder in checkout.packages.items()}
        for start in _candidate_start_folders(at, workspace, Path(script).parent):
            text = expand_home(texts[script], home, user)
            found = set(referenced_paths(text, _in_root(start), _in_root(at / Path(script).parent), packages))
            found |= {
                _in_root(resolve_mount(path, mounts)) for path in {*found, *absolute_paths(text, home, user)}
            }
            score = len(found & there), sum(source == workspace for source in mounts.values())
            if best is None or score > best[0]:
                best = score, Placement(at, workspace, start, mounts)
    assert best is not None
    placement = best[1]
    _add_moved_files(checkout, texts, placement, home, user)
    return placement


def _external_paths(
    checkout: Checkout, script: str, texts: Mapping[str, str], home: str, user: str
) -> List[str]:
    """Absolute paths outside of the checkout in any file, and those that the script reaches with ``cd``."""
    packages = {name: _in_root(folder) for name, folder in checkout.packages.items()}
    text = expand_home(texts[script], home, user)
    gone_to = referenced_paths(text, DEEP_FOLDER, f"{DEEP_FOLDER}/{Path(script).parent}", packages)
    named = {path for path in gone_to if not path.startswith(f"{ROOT}/") and _may_be_project_path(path)}
    return sorted(named.union(*(absolute_paths(text, home, user) for text in texts.values())))


def _add_moved_files(
    checkout: Checkout, texts: Mapping[str, str], placement: Placement, home: str, user: str
) -> None:
    """Add referenced files that were moved: beside the referencing file, or elsewhere if unique."""
    there = _existing_paths(checkout, placement.checkout, placement.workspace)
    folders = dict(placement.mounts)
    for file, text in sorted(texts.items()):
        for path in sorted(absolute_paths(text, home, user)):
            resolved = resolve_mount(path, folders)
            namesakes = [other for other in checkout.files if Path(other).name == Path(path).name]
            beside = [other for other in namesakes if Path(other).parent == Path(file).parent]
            found = beside or namesakes
            if len(found) != 1 or (resolved is not None and _in_root(resolved) in there):
                continue
            if resolved is None:
                placement.mounts[path] = placement.checkout / found[0]
            else:
                placement.links[resolved] = placement.checkout / found[0]


def absolute_paths(text: str, home: str, user: str) -> Set[str]:
    """Absolute paths in a text that may belong to the project, without system paths and topic names."""
    at = expand_home(text.replace("file://", ""), home, user)
    paths = (match.group(1).rstrip(".") for match in _ABSOLUTE.finditer(at))
    return {os.path.normpath(path) for path in paths if _may_be_project_path(path)}


def expand_home(text: str, home: str, user: str) -> str:
    """Expand ``~``, ``$HOME`` and ``$USER`` as a shell does."""
    text = _HOME.sub(lambda _: home, text)
    return text.replace("${USER}", user).replace("$USER", user)


def _may_be_project_path(path: str) -> bool:
    parts = path.split("/")[1:]
    is_file = "." in parts[-1] or "src" in parts or "devel" in parts
    return len(parts) >= 3 and parts[0] not in SYSTEM_FOLDERS and is_file and not path.startswith("/opt/ros")


def referenced_paths(text: str, start: str, script_folder: str, packages: Mapping[str, str]) -> Iterator[str]:
    """Paths that a shell script references or changes to.

    Interprets ``cd``, assignments, ``$(pwd)``, the script's folder and ``rospack find``; not a full shell.

    Args:
        text: The script.
        start: Absolute folder in which it is started.
        script_folder: Absolute folder of the script.
        packages: Package name -> absolute folder.

    Yields:
        Absolute, normalized paths.
    """
    text = _QUOTED_PIECE.sub(r"\2", _substituted(_SCRIPT_FOLDER, script_folder, text))
    text = _CD_PWD.sub(lambda match: _resolved(start, match.group(1)), text)
    text = _ROSPACK.sub(lambda match: packages.get(match.group(1) or match.group(2), "?"), text)
    folder, values = start, ShellVariables()
    for line in text.splitlines():
        line = values.substitute(_substituted(_WORKING_FOLDER, folder, line.split("#", 1)[0]))
        here, at = folder, 0
        for change in _CD.finditer(line):
            yield from _paths_in(line[at : change.start()], here)
            here, at = _resolved(here, change.group(1)), change.end()
            yield here
        yield from _paths_in(line[at:], here)
        if line.lstrip().startswith("cd "):
            folder = here


class ShellVariables:
    """Variables assigned in the lines of a shell script read so far."""

    def __init__(self):
        self._values: Dict[str, str] = {}

    def substitute(self, line: str) -> str:
        """Replace the variables in a line, then store the variable that it assigns."""
        for name, value in self._values.items():
            line = _substituted(re.compile(rf"\$(?:{name}\b|\{{{name}\}})"), value, line)
        assigned = _ASSIGNMENT.match(line)
        if assigned:
            self._values[assigned.group(1)] = assigned.group(2).strip("\"'")
        return line


def resolve_mount(path: str, mounts: Mapping[str, Path]) -> Optional[Path]:
    """Translate an absolute path into the folder mounted there; None if it is below no mount."""
    for target, source in mounts.items():
        if path == target or path.startswith(target + "/"):
            return source / path[len(target) :].lstrip("/")
    return None


def _in_root(path: Optional[Path]) -> str:
    return os.path.normpath(f"{ROOT}/{path}")


def _substituted(pattern: Pattern[str], value: str, text: str) -> str:
    return pattern.sub(lambda _: value, text)


def _resolved(folder: str, path: str) -> str:
    return os.path.normpath(path if path.startswith("/") else f"{folder}/{path}")


def _paths_in(text: str, folder: str) -> Iterator[str]:
    for word in _PATH.findall(text):
        word = word.rpartition(":=")[2]
        if "$" not in word and "://" not in word:
            yield _resolved(folder, word)


def _checkout_prefix(path: str, files: FrozenSet[str]) -> Optional[Tuple[str, bool]]:
    """The part of an absolute path that denotes the checkout (True) or its workspace (False)."""
    parts = path.split("/")
    for at in range(2, len(parts)):
        if "/".join(parts[at:]) in files:
            return "/".join(parts[:at]), True
    for name in ("src", "devel"):
        if name in parts[2:]:
            return "/".join(parts[: parts.index(name, 2)]), False
    return None


def _candidate_positions(checkout: Checkout, prefixes: Iterable[str]) -> List[Tuple[Path, Path]]:
    """Candidate folders of checkout and workspace, relative to the folder in which they are created."""
    if checkout.kind is CheckoutKind.WORKSPACE:
        assert checkout.workspace is not None
        return [(Path(), Path(checkout.workspace))]
    names = {Path(prefix).name for prefix in prefixes if Path(prefix).parent.name == "src"}
    inside = [(Path("src") / name, Path()) for name in sorted(names | {checkout.root.name})]
    return inside if checkout.kind is CheckoutKind.PACKAGE else [(Path("src"), Path()), *inside]


def _mounts(prefixes: List[Tuple[str, bool]], at: Path, workspace: Path) -> Iterator[Tuple[str, Path]]:
    for prefix, is_checkout in prefixes:
        if not is_checkout:
            yield prefix, workspace
        elif at != Path() and prefix.endswith(f"/{at}"):
            yield prefix[: -len(str(at)) - 1], Path()
        else:
            yield prefix, at


def _candidate_start_folders(at: Path, workspace: Path, script_folder: Path) -> List[Path]:
    """Folders from which authors start scripts, the most likely first."""
    return list(
        dict.fromkeys([workspace, at / script_folder, at, workspace / "src", at / script_folder.parent])
    )


def _with_parent_folders(files: Iterable[str]) -> FrozenSet[str]:
    return frozenset(
        part
        for file in files
        for part in (file, *(str(folder) for folder in Path(file).parents))
        if part != "."
    )


def _existing_paths(checkout: Checkout, at: Path, workspace: Path) -> FrozenSet[str]:
    made = [str(workspace / name) for name in BUILD_PRODUCTS]
    files = _with_parent_folders([*(str(at / file) for file in checkout.files), *made])
    return frozenset(map(_in_root, map(Path, files)))
