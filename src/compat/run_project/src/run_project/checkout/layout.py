"""Which kind of checkout a project is: a workspace, the content of its src, or one package."""

import enum
import os
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path
from typing import Dict, Iterator, List, Mapping, Optional, Tuple

from run_project.checkout.lent import files_of, lendable
from run_project.errors import ProjectError
from run_project.stand_ins.folders import PACKAGE_FOLDER

# What a build or a version control leaves in a checkout; never read, never copied.
LEFTOVERS = frozenset((".git", ".hg", ".svn", "build", "devel", "install", "logs"))
SCRIPTS = (".sh", ".bash")
WORD = "home_service"
LFS_POINTER = b"version https://git-lfs"


class Kind(enum.Enum):
    """What the top folder of a checkout is."""

    WORKSPACE = "a workspace"
    SOURCES = "the content of src"
    PACKAGE = "one package"


@dataclass(frozen=True)
class Checkout:
    """A project as it lies on the disk. All other paths are relative to ``root``.

    ``workspace`` is the folder that holds ``src``; None unless the kind is WORKSPACE.
    ``packages`` maps names to folders. ``lent``: folders of ours that take the place of missing ones;
    their files are among ``files``.
    """

    root: Path
    kind: Kind
    workspace: Optional[Path]
    packages: Dict[str, Path]
    files: Tuple[str, ...]
    lent: Mapping[Path, Path] = field(default_factory=dict)

    def scripts(self) -> List[Path]:
        """All shell scripts."""
        return [Path(file) for file in self.files if file.endswith(SCRIPTS)]

    def programs(self) -> List[Path]:
        """All shell scripts, and what else names its interpreter."""
        others = (file for file in self.files if Path(file).suffix in ("", ".py"))
        return self.scripts() + [Path(file) for file in others if _begins(self.root / file, b"#!")]

    def lfs_pointers(self) -> List[str]:
        """Files that were not fetched: what Git LFS puts in their place says where they are."""
        return [file for file in self.files if _begins(self.root / file, LFS_POINTER)]

    def model_folders(self) -> List[Path]:
        """All folders in which Gazebo's models lie, those that worlds name as ``model://name``."""
        models = (Path(file).parent for file in self.files if Path(file).name == "model.config")
        return sorted({model.parent for model in models})


def read_checkout(root: Path) -> Checkout:
    """Looks at the folder ``root``. Raises ProjectError if there is no package in it."""
    root = root.resolve()
    if not root.is_dir():
        raise ProjectError(f"{root}: no such folder")
    own = tuple(_files(root))
    scripts = ((root / file).read_text(errors="replace") for file in own if file.endswith(SCRIPTS))
    lent = lendable(root, scripts, PACKAGE_FOLDER.parent)
    files = (*own, *files_of(lent))
    packages = _packages(root, own)
    if not packages:
        hint = " (it has git submodules: have they been fetched?)" if ".gitmodules" in files else ""
        raise ProjectError(f"{root}: no package.xml in it or below{hint}")
    workspace = None
    if Path() in packages.values():
        kind = Kind.PACKAGE
    else:
        workspace = _workspace(packages)
        kind = Kind.SOURCES if workspace is None else Kind.WORKSPACE
    return Checkout(root, kind, workspace, packages, files, lent)


def choose_script(checkout: Checkout, wanted: Optional[str]) -> Path:
    """The script to run: the one ``wanted``, by path or by name, or home_service.sh.

    Raises ProjectError that names the scripts there are.
    """
    scripts = checkout.scripts()
    if wanted is None:
        chosen = [script for script in scripts if script.stem == WORD] or [
            script for script in scripts if is_errand(str(script))
        ]
    else:
        chosen = [Path(file) for file in checkout.files if file == os.path.normpath(wanted)] or [
            Path(file) for file in checkout.files if Path(file).name in (wanted, f"{wanted}.sh")
        ]
    if chosen:
        return min(chosen, key=lambda script: (len(script.parts), str(script)))
    names = ", ".join(str(script) for script in scripts) or "none"
    raise ProjectError(
        f"{checkout.root}: no script {wanted or WORD + '.sh'} in it; name another of its scripts: {names}"
    )


def is_errand(script: str) -> bool:
    """Whether a script drives the robot, by its name; others may just show a marker."""
    return _letters(WORD) in _letters(Path(script).stem)


def _begins(path: Path, content: bytes) -> bool:
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(len(content)) == content


def _letters(text: str) -> str:
    return "".join(letter for letter in text.lower() if letter.isalpha())


def _files(root: Path) -> Iterator[str]:
    for folder, folders, names in os.walk(root):
        folders[:] = sorted(name for name in folders if name not in LEFTOVERS)
        for name in sorted(names):
            yield os.path.relpath(f"{folder}/{name}", root)


def _packages(root: Path, files) -> Dict[str, Path]:
    packages: Dict[str, Path] = {}
    for file in files:
        path = Path(file)
        if path.name != "package.xml" or any(
            path.parent != p and p in path.parents for p in packages.values()
        ):
            continue
        try:
            name = ElementTree.parse(root / path).getroot().findtext("name", "").strip()
        except ElementTree.ParseError as error:
            raise ProjectError(f"{root / path}: {error}") from None
        if name and name not in packages:
            packages[name] = path.parent
    return packages


def _workspace(packages: Dict[str, Path]) -> Optional[Path]:
    """The folder above the ``src`` that holds most packages."""
    above = [
        parent.parent for folder in packages.values() for parent in folder.parents if parent.name == "src"
    ]
    return max(above, key=lambda folder: (above.count(folder), -len(folder.parts))) if above else None
