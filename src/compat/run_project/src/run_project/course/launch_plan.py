"""Launch plans of course projects without a script, recognized by the nodes in their launch files."""

import enum
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterator, Mapping, Optional, Set, Tuple

from run_project.checkout.layout import package_of
from run_project.checkout.vendored import is_vendored

_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_ARGUMENT = re.compile(r"<arg\b[^>]*>")
_NAME = re.compile(r'\bname\s*=\s*["\']([^"\']+)')
_USED = re.compile(r"\$\(arg (\w+)\)")
_INCLUDED = re.compile(r"<include\b[^>]*\bfile\s*=\s*[\"']([^\"']+)")
_WORLD = re.compile(r"empty_world\.launch|type=\"gz(?:server|ebo)\"")


class CourseProject(enum.Enum):
    """Project of the course; the value is its name on the command line."""

    MAP = "map_my_world"
    LOCALIZE = "where_am_i"
    CHASE = "go_chase_it"


# Node that identifies the launch file of a project, and the usual name of that file. Checked in this order,
# because later projects contain the earlier ones.
_SIGNATURES: Mapping[CourseProject, Tuple["re.Pattern[str]", str]] = {
    CourseProject.MAP: (re.compile(r'pkg="(?:rtabmap_ros|gmapping)"'), "mapping"),
    CourseProject.LOCALIZE: (re.compile(r'pkg="amcl"'), "amcl"),
    CourseProject.CHASE: (re.compile(r'type="process_image(?:\.py)?"'), "ball_chaser"),
}
# Launch files of rtabmap that need an existing database: not the start of a project.
_LOCALIZATION_ONLY = "localization"


@dataclass(frozen=True)
class ProjectLaunchPlan:
    """A course project and its launch files.

    Attributes:
        project: The project.
        launches: Arguments of roslaunch for each window, as ``my_robot world.launch``.
    """

    project: CourseProject
    launches: Tuple[str, ...]

    def script(self) -> str:
        """Shell script that opens a terminal window for each launch file."""
        lines = [f'xterm -e "roslaunch {launch}" &' for launch in self.launches]
        return "\n".join(["#!/bin/sh", *lines, "wait"]) + "\n"


def find_launch_plan(
    packages: Mapping[str, Path], texts: Mapping[str, str], wanted: Optional[str]
) -> Optional[ProjectLaunchPlan]:
    """Find the launch files of a course project.

    Args:
        packages: Package name -> folder, relative to the checkout.
        texts: Contents of the files, by path relative to the checkout.
        wanted: Name of the project; None for the last one that the checkout contains.

    Returns:
        The launch plan, or None if no launch file starts the nodes of the project.
    """
    launches = dict(_launch_files(packages, texts))
    # Copies of public packages start the nodes of every course project: they make none of it.
    own = {name: folder for name, folder in packages.items() if not is_vendored(name)}
    candidates = launches if wanted is not None else dict(_launch_files(own, texts))
    for project, (signature, name) in _SIGNATURES.items():
        if wanted not in (None, project.value):
            continue
        started = [
            file
            for file, text in candidates.items()
            if signature.search(text)
            or (Path(file).stem == name and any(signature.search(part) for part in _included(text, launches)))
        ]
        if not started:
            continue
        chosen = min(started, key=lambda file: _name_rank(file, name))
        worlds = [file for file, text in launches.items() if _WORLD.search(text)]
        world = min(worlds, key=lambda file: _name_rank(file, "world"), default=chosen)
        has_world = world == chosen or f"/{Path(world).name}" in launches[chosen]
        files = (chosen,) if has_world else (world, chosen)
        return ProjectLaunchPlan(
            project,
            tuple(
                _with_required_arguments(_roslaunch_arguments(file, packages), launches[file], texts)
                for file in files
            ),
        )
    return None


def _launch_files(packages: Mapping[str, Path], texts: Mapping[str, str]) -> Iterator[Tuple[str, str]]:
    for file, text in texts.items():
        if file.endswith(".launch") and any(folder in Path(file).parents for folder in packages.values()):
            yield file, _COMMENT.sub("", text)


def _included(text: str, launches: Mapping[str, str]) -> Iterator[str]:
    """Texts of the launch files that a launch file includes, matched by name."""
    names = {Path(path).name for path in _INCLUDED.findall(text)}
    return (other for file, other in launches.items() if Path(file).name in names)


def _name_rank(file: str, name: str) -> Tuple[bool, bool, int, str]:
    """Sort key: the usual name first."""
    stem = Path(file).stem
    return _LOCALIZATION_ONLY in stem, stem != name, len(file), file


def _roslaunch_arguments(file: str, packages: Mapping[str, Path]) -> str:
    return f"{package_of(Path(file), packages)} {Path(file).name}"


def _with_required_arguments(words: str, launch: str, texts: Mapping[str, str]) -> str:
    """Add the arguments that the author's scripts pass, if the launch file has required ones."""
    required = _required_arguments(launch)
    if not required:
        return words
    command = r"[ \t]+".join(map(re.escape, ["roslaunch", *words.split()]))
    call = re.compile(command + r"((?:[ \t]+\w+:=[^\s\"';&`]+)+)")
    for _, text in sorted(texts.items()):
        for arguments in call.findall(text):
            given = arguments.split()
            if required <= {word.partition(":=")[0] for word in given}:
                return " ".join([words, *given])
    return words


def _required_arguments(launch: str) -> Set[str]:
    """Arguments of a launch file without a default."""
    declared: Dict[str, bool] = {}
    for tag in _ARGUMENT.findall(launch):
        for name in _NAME.findall(tag):
            declared[name] = declared.get(name, False) or bool(re.search(r"\b(?:default|value)\s*=", tag))
    return {name for name in {*declared, *_USED.findall(launch)} if not declared.get(name)}
