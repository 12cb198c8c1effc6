"""Layout of a checkout: a workspace, the content of its src folder, or one package."""

import enum
import os
import re
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path
from typing import Dict, Iterator, List, Mapping, Optional, Tuple

from planar import PlanarError
from run_project.checkout.substitutes import find_substitutes, substitute_files
from run_project.stand_ins import PACKAGE_FOLDER

# Folders of builds and version control: neither read nor copied.
BUILD_AND_VCS_FOLDERS = frozenset((".git", ".hg", ".svn", "build", "devel", "install", "logs"))
SCRIPTS = (".sh", ".bash")
LFS_POINTER = b"version https://git-lfs"
_MAP_IMAGE = re.compile(r"^image:\s*[\"']?([^\s\"']+)", re.MULTILINE)
_MAP_RESOLUTION = re.compile(r"^resolution:", re.MULTILINE)


class ProjectError(PlanarError):
    """The given path is not a project that can be run; the text states why."""


class CheckoutKind(enum.Enum):
    """What the top folder of a checkout contains."""

    WORKSPACE = "a workspace"
    SOURCES = "the content of src"
    PACKAGE = "one package"


@dataclass(frozen=True)
class Checkout:
    """Files and packages of a project. Paths are relative to ``root`` unless stated otherwise.

    Attributes:
        root: Absolute path of the checkout.
        kind: Layout of the checkout.
        workspace: Folder that contains ``src``; None unless the kind is WORKSPACE.
        packages: Package name -> folder.
        files: All files, including those of ``substitutes``.
        substitutes: Missing package folder -> absolute folder of this workspace's package that replaces it.
    """

    root: Path
    kind: CheckoutKind
    workspace: Optional[Path]
    packages: Dict[str, Path]
    files: Tuple[str, ...]
    substitutes: Mapping[Path, Path] = field(default_factory=dict)

    def scripts(self) -> List[Path]:
        """All shell scripts."""
        return [Path(file) for file in self.files if file.endswith(SCRIPTS)]

    def launch_files(self) -> List[Path]:
        """All launch files in packages."""
        files = (Path(file) for file in self.files if file.endswith(".launch"))
        return [file for file in files if self.package_of(file) is not None]

    def package_of(self, file: Path) -> Optional[str]:
        """Name of the package that contains a file; None if it is in none."""
        return package_of(file, self.packages)

    def programs(self) -> List[Path]:
        """All shell scripts, and all other files that start with ``#!``."""
        others = (file for file in self.files if Path(file).suffix in ("", ".py"))
        return self.scripts() + [Path(file) for file in others if _starts_with(self.root / file, b"#!")]

    def lfs_pointers(self) -> List[str]:
        """Files that Git LFS has not fetched: the checkout contains only their pointers."""
        return [file for file in self.files if _starts_with(self.root / file, LFS_POINTER)]

    def own_files(self) -> List[str]:
        """All files but those of substitutes."""
        return [file for file in self.files if self.substitutes.keys().isdisjoint(Path(file).parents)]

    def worlds(self) -> List[str]:
        """All worlds of the project's own."""
        return [file for file in self.own_files() if file.endswith(".world")]

    def maps(self) -> Dict[str, str]:
        """Images of all maps of the project's own, by map file."""
        found = {}
        for file in self.own_files():
            path = self.root / file
            if path.suffix in (".yaml", ".yml") and path.is_file():
                text = path.read_text(errors="replace")
                image = _MAP_IMAGE.search(text)
                if image and _MAP_RESOLUTION.search(text):
                    found[file] = image.group(1)
        return found

    def maps_without_image(self) -> List[str]:
        """Map files whose image is not in the checkout, with its name: map_server refuses them."""
        names = {Path(file).name for file in self.files}
        return [f"{file} ({image})" for file, image in self.maps().items() if Path(image).name not in names]

    def model_folders(self) -> List[Path]:
        """Folders that contain Gazebo models, as referenced by ``model://NAME`` in worlds."""
        models = (Path(file).parent for file in self.files if Path(file).name == "model.config")
        return sorted({model.parent for model in models})


def package_of(file: Path, packages: Mapping[str, Path]) -> Optional[str]:
    """Name of the innermost package that contains a file; None if it is in none.

    Args:
        file: Path of the file.
        packages: Package name -> folder, relative to the same folder as the file.
    """
    inside = {name: folder for name, folder in packages.items() if folder in file.parents}
    return max(inside, key=lambda name: len(inside[name].parts)) if inside else None


def read_checkout(root: Path) -> Checkout:
    """Read the layout of a checkout.

    Args:
        root: Folder of the checkout.

    Raises:
        ProjectError: The folder does not exist or contains no package.
    """
    root = root.resolve()
    if not root.is_dir():
        raise ProjectError(f"{root}: no such folder; expected the checkout of a project")
    own = tuple(_files(root))
    scripts = ((root / file).read_text(errors="replace") for file in own if file.endswith(SCRIPTS))
    substitutes = find_substitutes(root, scripts, PACKAGE_FOLDER.parent)
    files = (*own, *substitute_files(substitutes))
    packages = _packages(root, own)
    if not packages:
        hint = (
            " (its git submodules may be missing: git submodule update --init)"
            if ".gitmodules" in files
            else ""
        )
        raise ProjectError(f"{root}: no package.xml in this folder or below{hint}")
    workspace = None
    if Path() in packages.values():
        kind = CheckoutKind.PACKAGE
    else:
        workspace = _workspace(packages)
        kind = CheckoutKind.SOURCES if workspace is None else CheckoutKind.WORKSPACE
    return Checkout(root, kind, workspace, packages, files, substitutes)


def _starts_with(path: Path, content: bytes) -> bool:
    if not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(len(content)) == content


def _files(root: Path) -> Iterator[str]:
    for folder, folders, names in os.walk(root):
        folders[:] = sorted(name for name in folders if name not in BUILD_AND_VCS_FOLDERS)
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
    """The parent of the ``src`` folder that contains most packages."""
    above = [
        parent.parent for folder in packages.values() for parent in folder.parents if parent.name == "src"
    ]
    return max(above, key=lambda folder: (above.count(folder), -len(folder.parts))) if above else None
