"""Folders that git left empty: where a repository or a package was that ours stand in for, ours is lent."""

import os
import re
from pathlib import Path
from typing import Dict, Iterable, Mapping, Tuple

# The packages of the repositories that projects have as submodules.
REPOSITORIES: Mapping[str, Tuple[str, ...]] = {
    "turtlebot": ("turtlebot_bringup", "turtlebot_description", "turtlebot_teleop"),
    "turtlebot_simulator": ("turtlebot_gazebo",),
    "turtlebot_apps": ("turtlebot_navigation",),
    "turtlebot_interactions": ("turtlebot_rviz_launchers",),
    "slam_gmapping": ("gmapping",),
    "navigation": ("amcl", "map_server", "move_base"),
    "gazebo_ros_pkgs": ("gazebo_ros", "gazebo_msgs"),
}
IGNORED = "CATKIN_IGNORE"


def find_substitutes(root: Path, named: Iterable[str], stand_ins: Path) -> Dict[Path, Path]:
    """Which of our package folders to lend to the checkout at ``root``, by the folders to be seen as them.

    Those are relative: what is empty in the checkout, what its .gitmodules name, and, of what is ``named`` as
    ``repository/package`` in the texts of its scripts, what is not there, beside the other packages.
    """
    substitutes: Dict[Path, Path] = {}
    for folder in sorted({*_empty(root), *_submodules(root), *_named(root, named)}):
        packages = REPOSITORIES.get(folder.name)
        if packages is None and (stand_ins / folder.name / "package.xml").is_file():
            substitutes[folder] = stand_ins / folder.name
        for package in packages or ():
            substitutes[folder / package] = stand_ins / package
    return substitutes


def link_substitutes(substitutes: Mapping[Path, Path], checkout: Path) -> None:
    """Makes the folders in the copy ``checkout``, with links to what is in ours; none is built again."""
    for folder, package in substitutes.items():
        target = checkout / folder
        target.mkdir(parents=True, exist_ok=True)
        (target / IGNORED).touch()
        for entry in package.iterdir():
            (target / entry.name).symlink_to(entry)


def substitute_files(substitutes: Mapping[Path, Path]) -> Iterable[str]:
    """All files that the lent folders have, relative to the checkout."""
    for folder, package in substitutes.items():
        for file in package.rglob("*"):
            if file.is_file():
                yield str(folder / file.relative_to(package))


def _empty(root: Path) -> Iterable[Path]:
    for folder, folders, names in os.walk(root):
        if ".git" in folders:
            folders.remove(".git")
        if not folders and not set(names) - {".git", ".gitkeep"}:
            yield Path(folder).relative_to(root)


def _submodules(root: Path) -> Iterable[Path]:
    file = root / ".gitmodules"
    if file.is_file():
        for path in re.findall(r"^\s*path\s*=\s*(\S+)", file.read_text(errors="replace"), re.MULTILINE):
            if not (root / path).exists():
                yield Path(path)


def _named(root: Path, texts: Iterable[str]) -> Iterable[Path]:
    text = "\n".join(texts)
    for repository, packages in REPOSITORIES.items():
        is_named = any(f"{repository}/{package}/" in text for package in packages)
        if is_named and not any(root.rglob(repository)):
            yield _beside_packages(root) / repository


def _beside_packages(root: Path) -> Path:
    """Relative to ``root``: where most of its packages lie."""
    above = [file.parent.parent for file in root.rglob("package.xml") if file.parent != root]
    return max(sorted(set(above)), key=above.count, default=root).relative_to(root)
