#!/usr/bin/env python3
"""Count retired words, duplicate class names and very short modules, and list where they are.

python3 tests/repository/vocabulary.py [PATH...] [--root CHECKOUT] [--list]
"""

import argparse
import ast
import fnmatch
import re
import subprocess
import sys
from collections import defaultdict
from functools import lru_cache
from pathlib import Path
from typing import Dict, Iterator, List, NamedTuple, Optional, Sequence, Tuple

import yaml

ROOT = Path(__file__).resolve().parents[2]
WORDS_FILE = Path(__file__).with_name("retired_words.yaml")
SHORT_MODULE = 25
TEXT_SUFFIXES = {".py", ".md", ".yaml", ".yml", ".sh", ".launch", ".test", ".msg", ".srv", ".action", ".toml"}
TEXT_SUFFIXES |= {".txt", ".xml", ".json", ".html", ".css", ".js", ".cff", ".rst", ".cfg", ".in", ""}
# What is searched in a copy without git.
SOURCES = ("src", "tests", "docs", "scripts", "scenarios", "docker", "map", "rvizConfig", "*.md", "*.toml")
CAMEL = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|_")


class Retired(NamedTuple):
    """A pattern of retired words, what replaces it, and text in which it is allowed."""

    pattern: "re.Pattern[str]"
    use: str
    allowed: "Optional[re.Pattern[str]]"


class Hit(NamedTuple):
    """A retired word: where it stands, what was found there, and the replacement."""

    path: str
    line: int
    found: str
    use: str

    def __str__(self) -> str:
        return f'{self.path}:{self.line}: "{self.found}" is retired; use: {self.use}'


def load_rules() -> dict:
    """Read the lists of retired_words.yaml."""
    return yaml.safe_load(WORDS_FILE.read_text(encoding="utf-8"))


def retired_words(rules: dict) -> List[Retired]:
    """Compile the text patterns of the rules."""
    compiled = []
    for entry in rules["text"]:
        allowed = re.compile(entry["except"], re.IGNORECASE) if "except" in entry else None
        compiled.append(Retired(re.compile(rf"\b({entry['words']})\b", re.IGNORECASE), entry["use"], allowed))
    return compiled


def text_files(root: Path, paths: Sequence[str] = ()) -> List[str]:
    """Return the tracked text files of a checkout, or all text files of a copy without git."""
    command = ["git", "-C", str(root), "ls-files", "-z", "--", *paths]
    listed = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
    if listed.returncode == 0:
        names = listed.stdout.decode().split("\0")
    else:
        found = (path for part in SOURCES for path in [*root.glob(part), *root.glob(f"{part}/**/*")])
        names = sorted(str(path.relative_to(root)) for path in found if "__pycache__" not in path.parts)
    return [name for name in names if (root / name).is_file() and Path(name).suffix in TEXT_SUFFIXES]


def find_hits(root: Path, names: Sequence[str], rules: dict) -> Iterator[Hit]:
    """Yield each retired word in the text and in the names of files."""
    words = retired_words(rules)
    for name in names:
        if any(fnmatch.fnmatch(name, pattern) for pattern in rules["skip"]):
            continue
        exempt = [
            re.compile(each["line"]) for each in rules["allowed"] if fnmatch.fnmatch(name, each["files"])
        ]
        yield from hits_of(name, 0, name.replace("/", " "), words)
        text = (root / name).read_text(encoding="utf-8", errors="replace")
        for number, line in enumerate(text.splitlines(), 1):
            if not any(pattern.search(line) for pattern in exempt):
                yield from hits_of(name, number, line, words)


def hits_of(name: str, number: int, line: str, words: Sequence[Retired]) -> Iterator[Hit]:
    """Yield the retired words of one line, whose identifiers are split into words first."""
    split = CAMEL.sub(" ", line)
    for retired in words:
        text = retired.allowed.sub("", split) if retired.allowed else split
        for found in retired.pattern.finditer(text):
            yield Hit(name, number, found.group(), retired.use)


def source_modules(root: Path) -> List[Path]:
    """All Python modules of the workspace's packages but their tests."""
    return sorted(path for path in root.glob("src/**/*.py") if "test" not in path.relative_to(root).parts)


@lru_cache(maxsize=None)
def definitions(root: Path) -> List[Tuple[str, int, str, str]]:
    """List (path, line, kind, name) of each class and function in the packages."""
    found = []
    for path in source_modules(root):
        name = str(path.relative_to(root))
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef):
                found.append((name, node.lineno, "class", node.name))
            elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                found.append((name, node.lineno, "function", node.name))
    return found


def retired_definitions(root: Path, rules: dict) -> List[str]:
    """Classes and functions with retired names."""
    retired = {"class": set(rules["classes"]), "function": set(rules["methods"])}
    return [
        f"{path}:{line}: {kind} {name}"
        for path, line, kind, name in definitions(root)
        if name in retired[kind]
    ]


def duplicate_classes(root: Path) -> Dict[str, List[str]]:
    """Class names that are defined more than once, with the places of their definitions."""
    places: Dict[str, List[str]] = defaultdict(list)
    for path, line, kind, name in definitions(root):
        if kind == "class" and "/templates/" not in path:
            places[name].append(f"{path}:{line}")
    return {name: found for name, found in sorted(places.items()) if len(found) > 1}


def short_modules(root: Path) -> List[str]:
    """Modules under SHORT_MODULE lines that are not ``__init__``, ``setup`` or ``__main__``."""
    exempt = {"__init__.py", "setup.py", "__main__.py"}
    return [
        str(path.relative_to(root))
        for path in source_modules(root)
        if path.name not in exempt and len(path.read_text(encoding="utf-8").splitlines()) < SHORT_MODULE
    ]


def line_count(path: Path) -> int:
    return len(path.read_text(encoding="utf-8").splitlines())


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "paths", nargs="*", metavar="PATH", help="only words in these (default: the whole tree)"
    )
    parser.add_argument("--root", type=Path, default=ROOT, metavar="CHECKOUT", help="default: this one")
    parser.add_argument("--list", action="store_true", help="list every place, not only counts")
    options = parser.parse_args()
    rules, root = load_rules(), options.root.resolve()
    hits = list(find_hits(root, text_files(root, options.paths), rules))
    counts: Dict[str, int] = defaultdict(int)
    for hit in hits:
        counts[hit.use] += 1
    duplicates, short, names = duplicate_classes(root), short_modules(root), retired_definitions(root, rules)
    if options.list:
        print(*hits, sep="\n")
        print(*(f"{name}: {', '.join(places)}" for name, places in duplicates.items()), sep="\n")
        print(*short, *names, sep="\n")
    for use, count in sorted(counts.items(), key=lambda item: -item[1]):
        print(f"{count:6d}  retired words for: {use}")
    first = rules["text"][0]["use"]
    print(f"{len(hits):6d}  retired words in all, {counts[first]} of them tell, tells, told, telling")
    print(f"{len(names):6d}  retired names of classes and functions")
    print(f"{len(duplicates):6d}  class names used more than once")
    print(f"{len(short):6d}  modules under {SHORT_MODULE} lines")
    print(f"{line_count(root / 'README.md'):6d}  lines of README.md")
    print(f"{line_count(root / 'CHANGELOG.md'):6d}  lines of CHANGELOG.md")
    return 0


if __name__ == "__main__":
    sys.exit(main())
