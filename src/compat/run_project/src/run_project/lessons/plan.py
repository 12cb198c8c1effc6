"""Projects of the course that have no script of their own, recognised by what their launch files start."""

import enum
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterator, Mapping, Optional, Tuple

_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_WORLD = re.compile(r"empty_world\.launch|type=\"gz(?:server|ebo)\"")


class Lesson(enum.Enum):
    """Which project of the course; the value is what it is called on the command line."""

    MAP = "map_my_world"
    LOCALIZE = "where_am_i"
    CHASE = "go_chase_it"


# What the launch file of a lesson starts, and how it is called most often; later ones
# contain earlier ones.
_SIGNS: Mapping[Lesson, Tuple["re.Pattern[str]", str]] = {
    Lesson.MAP: (re.compile(r'pkg="(?:rtabmap_ros|gmapping)"'), "mapping"),
    Lesson.LOCALIZE: (re.compile(r'pkg="amcl"'), "amcl"),
    Lesson.CHASE: (re.compile(r'type="process_image(?:\.py)?"'), "ball_chaser"),
}
# With a database that is already there, which no lesson begins with.
_AFTERWARDS = "localization"


@dataclass(frozen=True)
class Plan:
    """A lesson, and the words after roslaunch, one a window: ``my_robot world.launch``."""

    lesson: Lesson
    launches: Tuple[str, ...]

    def script(self) -> str:
        """What a person types, each line in a terminal of its own."""
        lines = [f'xterm -e "roslaunch {launch}" &' for launch in self.launches]
        return "\n".join(["#!/bin/sh", *lines, "wait"]) + "\n"


def plan_of(packages: Mapping[str, Path], texts: Mapping[str, str], wanted: Optional[str]) -> Optional[Plan]:
    """The lesson of a checkout with ``packages`` (folders by name), the ``wanted`` one or the last there is.

    ``texts``: the contents of its files by path. None if there is none.
    """
    launches = dict(_launch_files(packages, texts))
    for lesson, (sign, name) in _SIGNS.items():
        if wanted not in (None, lesson.value):
            continue
        started = [file for file, text in launches.items() if sign.search(text)]
        if not started:
            continue
        chosen = min(started, key=lambda file: _oddity(file, name))
        worlds = [file for file, text in launches.items() if _WORLD.search(text)]
        world = min(worlds, key=lambda file: _oddity(file, "world"), default=chosen)
        has_world = world == chosen or f"/{Path(world).name}" in launches[chosen]
        files = (chosen,) if has_world else (world, chosen)
        return Plan(lesson, tuple(_words(file, packages) for file in files))
    return None


def _launch_files(packages: Mapping[str, Path], texts: Mapping[str, str]) -> Iterator[Tuple[str, str]]:
    for file, text in texts.items():
        if file.endswith(".launch") and any(folder in Path(file).parents for folder in packages.values()):
            yield file, _COMMENT.sub("", text)


def _oddity(file: str, name: str) -> Tuple[bool, bool, int, str]:
    """Small for what is called as most call it."""
    stem = Path(file).stem
    return _AFTERWARDS in stem, stem != name, len(file), file


def _words(file: str, packages: Mapping[str, Path]) -> str:
    inside: Dict[str, Path] = {
        name: folder for name, folder in packages.items() if folder in Path(file).parents
    }
    package = max(inside, key=lambda name: len(inside[name].parts))
    return f"{package} {Path(file).name}"
