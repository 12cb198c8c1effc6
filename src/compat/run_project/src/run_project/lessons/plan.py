"""Projects of the course that have no script of their own, recognised by what their launch files start."""

import enum
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Iterator, Mapping, Optional, Set, Tuple

_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_ARGUMENT = re.compile(r"<arg\b[^>]*>")
_NAME = re.compile(r'\bname\s*=\s*["\']([^"\']+)')
_USED = re.compile(r"\$\(arg (\w+)\)")
_INCLUDED = re.compile(r"<include\b[^>]*\bfile\s*=\s*[\"']([^\"']+)")
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
        started = [
            file
            for file, text in launches.items()
            if sign.search(text)
            or (Path(file).stem == name and any(sign.search(part) for part in _included(text, launches)))
        ]
        if not started:
            continue
        chosen = min(started, key=lambda file: _oddity(file, name))
        worlds = [file for file, text in launches.items() if _WORLD.search(text)]
        world = min(worlds, key=lambda file: _oddity(file, "world"), default=chosen)
        has_world = world == chosen or f"/{Path(world).name}" in launches[chosen]
        files = (chosen,) if has_world else (world, chosen)
        return Plan(
            lesson, tuple(_as_called(_words(file, packages), launches[file], texts) for file in files)
        )
    return None


def _launch_files(packages: Mapping[str, Path], texts: Mapping[str, str]) -> Iterator[Tuple[str, str]]:
    for file, text in texts.items():
        if file.endswith(".launch") and any(folder in Path(file).parents for folder in packages.values()):
            yield file, _COMMENT.sub("", text)


def _included(text: str, launches: Mapping[str, str]) -> Iterator[str]:
    """The launch files that one includes, by their names."""
    names = {Path(path).name for path in _INCLUDED.findall(text)}
    return (other for file, other in launches.items() if Path(file).name in names)


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


def _as_called(words: str, launch: str, texts: Mapping[str, str]) -> str:
    """With the arguments that its author's scripts give, if the launch file lacks some without them."""
    lacking = _lacking(launch)
    if not lacking:
        return words
    command = r"[ \t]+".join(map(re.escape, ["roslaunch", *words.split()]))
    call = re.compile(command + r"((?:[ \t]+\w+:=[^\s\"';&`]+)+)")
    for _, text in sorted(texts.items()):
        for arguments in call.findall(text):
            given = arguments.split()
            if lacking <= {word.partition(":=")[0] for word in given}:
                return " ".join([words, *given])
    return words


def _lacking(launch: str) -> Set[str]:
    """Arguments of a launch file that have no value unless they are given one."""
    declared: Dict[str, bool] = {}
    for tag in _ARGUMENT.findall(launch):
        for name in _NAME.findall(tag):
            declared[name] = declared.get(name, False) or bool(re.search(r"\b(?:default|value)\s*=", tag))
    return {name for name in {*declared, *_USED.findall(launch)} if not declared.get(name)}
