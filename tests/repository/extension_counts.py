#!/usr/bin/env python3
"""Count the code of plugins and their guards, the files with guards, and the import circles of files.

python3 tests/repository/extension_counts.py [ROOT]
"""

import argparse
import ast
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Collection, Dict, Iterator, List, Set, Tuple

import code_lines
from structure import ROOT, modules

# Files of the mechanism: loading, registries, guards, checks of contracts, templates and their command. The
# names of former versions are among them, so that the counts can be compared.
MECHANISM = re.compile(
    r"""
    /planar/(extensions/.*|plugins|plugin_check|contract_check)\.py$
    | /move_base_lite/(plugin|plugin_guard|guarding|thread_time|own_time)\.py$
    | /(control|planning|recovery|costmap|faults)/registry\.py$ | /guarded\.py$
    | /amcl_lite/(own|custom)_model\.py$ | /faults/(own|custom)\.py$
    | /(amcl_lite|slam_lite|sim_bridge|laboratory|move_base_lite)/check(/.*)?\.py$
    | /commands/new_plugin\.py$ | /home_service/templates/.*\.py$
    """,
    re.VERBOSE,
)
# Files with the protocol of an extension point, and the definitions in them that are not the protocol but its
# mechanism.
PROTOCOLS = re.compile(
    r"""
    /control/local_planner\.py$ | /planning/global_planner\.py$
    | /recovery/behavior\.py$ | /costmap/layer\.py$
    | /(motion|sensor)/(own|custom)_model\.py$ | /matching/scan_matcher\.py$ | /faults/kind\.py$
    | /worlds/(own|custom)\.py$ | /(home_service|supervision)/command\.py$
    """,
    re.VERBOSE,
)
PART = re.compile(
    r"CONTRACT|Guarded|Own|Custom|_?checked|_?problem|_?requirements|_?load|_?read|_?from_old|\w+_of$|__getattr__"
)
GUARD = re.compile(r"(Plugin)?Guard$|Guarded|(Own|Custom)\w*Model$|OwnWorlds$")


@dataclass(frozen=True)
class Counts:
    """What the mechanism costs.

    Attributes:
        files: Its files with their numbers of lines: all, and those of code, without docstrings, comments and
            blank lines.
        guard_files: Files with guards.
        circles: Files that import each other, by circle.
    """

    files: Dict[str, Tuple[int, int]]
    guard_files: List[str]
    circles: List[List[str]]

    @property
    def lines(self) -> Tuple[int, int]:
        """Lines of the mechanism: all, and those of code."""
        every, code = zip(*self.files.values())
        return sum(every), sum(code)


def counts(root: Path) -> Counts:
    """Count in a checkout."""
    files: Dict[str, Tuple[int, int]] = {}
    guard_files = []
    for path in (*modules(root), *root.glob("src/home_service/templates/*.py")):
        place, text = path.relative_to(root).as_posix(), path.read_text(encoding="utf-8")
        parts = [*_parts(ast.parse(text))] if PROTOCOLS.search(place) else []
        if MECHANISM.search(place):
            files[place] = len(text.splitlines()), len(code_lines.numbers_of_code(text))
        elif parts:
            lines = {line for _, first, last in parts for line in range(first, last + 1)}
            files[place] = len(lines), len(lines & code_lines.numbers_of_code(text))
        if place in files and any(GUARD.match(name) for name in _classes(ast.parse(text))):
            guard_files.append(place)
    return Counts(files, sorted(guard_files), circles(root))


def _classes(tree: ast.Module) -> Iterator[str]:
    return (node.name for node in tree.body if isinstance(node, ast.ClassDef))


def _parts(tree: ast.Module) -> Iterator[Tuple[str, int, int]]:
    """Name, first and last line of each top-level definition that belongs to the mechanism."""
    for node in tree.body:
        target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
        name = getattr(node, "name", getattr(target, "id", ""))
        if PART.match(name):
            decorators = getattr(node, "decorator_list", [])
            yield name, min([node.lineno, *(each.lineno for each in decorators)]), node.end_lineno or 0


def circles(root: Path) -> List[List[str]]:
    """Return the groups of modules that import each other, also late or for annotations only."""
    paths = {_module_name(path): path for path in modules(root)}
    graph = {
        name: {each for each in _imports(path, paths) if each in paths and each != name}
        for name, path in paths.items()
    }
    return sorted(sorted(group) for group in _strongly_connected(graph) if len(group) > 1)


def _module_name(path: Path) -> str:
    parts = path.with_suffix("").parts
    inner = parts[len(parts) - parts[::-1].index("src") :]
    return ".".join(inner[:-1] if inner[-1] == "__init__" else inner)


def _imports(path: Path, names: Collection[str]) -> Iterator[str]:
    """Imported modules: ``from a import b`` imports the module a.b if there is one, else a."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            inner = (f"{node.module}.{alias.name}" for alias in node.names)
            yield from (each if each in names else node.module for each in inner)


def _strongly_connected(graph: Dict[str, Set[str]]) -> List[Set[str]]:
    """Kosaraju's algorithm."""
    order: List[str] = []
    seen: Set[str] = set()
    for start in graph:
        stack: List[Tuple[str, bool]] = [(start, False)]
        while stack:
            name, is_done = stack.pop()
            if is_done:
                order.append(name)
            elif name not in seen:
                seen.add(name)
                stack.append((name, True))
                stack += [(each, False) for each in graph[name]]
    users: Dict[str, Set[str]] = {name: set() for name in graph}
    for name, used in graph.items():
        for each in used:
            users[each].add(name)
    groups, assigned = [], set()
    for root in reversed(order):
        group, names = set(), [root]
        while names:
            name = names.pop()
            if name not in assigned:
                assigned.add(name)
                group.add(name)
                names += users[name]
        if group:
            groups.append(group)
    return groups


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("root", nargs="?", type=Path, default=ROOT, help="a checkout (default: this)")
    found = counts(parser.parse_args().root)
    for place, lines in sorted(found.files.items()):
        print(f"{lines[0]:5d} {lines[1]:5d}  {place}")
    print(f"{found.lines[0]:5d} {found.lines[1]:5d}  lines, and lines of code, in {len(found.files)} files")
    for title, rows in (("files with guards", found.guard_files), ("import circles", found.circles)):
        print(f"\n{title}: {len(rows)}")
        for row in rows:
            print(f"  {row if isinstance(row, str) else ', '.join(row)}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
