"""Substitutes for missing submodules: packages of this workspace, linked into the copy of the checkout."""

import os
import re
from pathlib import Path
from typing import Dict, Iterable, Mapping, Tuple

# Repositories that projects include as submodules, and the packages of this workspace that replace them.
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
ROBOTS = (".xacro", ".urdf")


def find_substitutes(root: Path, script_texts: Iterable[str], stand_ins: Path) -> Dict[Path, Path]:
    """Find the packages that replace missing folders of a checkout.

    Missing are empty folders, submodules of .gitmodules that do not exist, and repositories that a script
    references as ``repository/package/`` and that do not exist; these belong beside the other packages.

    Args:
        root: Folder of the checkout.
        script_texts: Texts of its scripts.
        stand_ins: Folder with the packages of this workspace that replace official ones.

    Returns:
        Folder relative to the checkout -> absolute folder of the replacing package.
    """
    substitutes: Dict[Path, Path] = {}
    for folder in sorted({*_empty(root), *_submodules(root), *_referenced(root, script_texts)}):
        packages = REPOSITORIES.get(folder.name)
        if packages is None and (stand_ins / folder.name / "package.xml").is_file():
            substitutes[folder] = stand_ins / folder.name
        for package in packages or ():
            substitutes[folder / package] = stand_ins / package
    return substitutes


def link_substitutes(substitutes: Mapping[Path, Path], checkout: Path) -> None:
    """Create the missing folders in a copy of the checkout, with links to the substitutes' files.

    CATKIN_IGNORE keeps them from being built a second time.
    """
    for folder, package in substitutes.items():
        target = checkout / folder
        target.mkdir(parents=True, exist_ok=True)
        (target / IGNORED).touch()
        for entry in package.iterdir():
            (target / entry.name).symlink_to(entry)


def complete_package(package: Path, stand_in: Path, replaces_robots: bool) -> None:
    """Link what the stand-in has more into a package of the copy: files of the author's take precedence.

    Programs are those of the stand-in: others of the same name are no longer executable, since rosrun starts
    a program only if the package has one of its name.

    Args:
        package: Folder of the package.
        stand_in: Folder of this workspace's package of the same name.
        replaces_robots: Robot descriptions of the stand-in take precedence.
    """
    files = [file for file in sorted(stand_in.rglob("*")) if file.is_file()]
    programs = {file.name for file in files if os.access(file, os.X_OK)}
    for file in package.rglob("*"):
        if file.name in programs and file.is_file():
            file.chmod(file.stat().st_mode & ~0o111)
    for file in files:
        target = package / file.relative_to(stand_in)
        if any(parent.is_file() for parent in target.parents):
            continue
        if file.name in programs or (replaces_robots and file.suffix in ROBOTS):
            target.unlink(missing_ok=True)
        if not target.exists() and not target.is_symlink():
            target.parent.mkdir(parents=True, exist_ok=True)
            target.symlink_to(file)


def substitute_files(substitutes: Mapping[Path, Path]) -> Iterable[str]:
    """All files of the substitutes, relative to the checkout."""
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


def _referenced(root: Path, texts: Iterable[str]) -> Iterable[Path]:
    text = "\n".join(texts)
    for repository, packages in REPOSITORIES.items():
        is_named = any(f"{repository}/{package}/" in text for package in packages)
        if is_named and not any(root.rglob(repository)):
            yield _beside_packages(root) / repository


def _beside_packages(root: Path) -> Path:
    """The folder, relative to ``root``, that contains most packages."""
    above = [file.parent.parent for file in root.rglob("package.xml") if file.parent != root]
    return max(sorted(set(above)), key=above.count, default=root).relative_to(root)
