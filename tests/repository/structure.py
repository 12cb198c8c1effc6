#!/usr/bin/env python3
"""Measure the structure: modules per folder, the longest classes and functions.

python3 tests/repository/structure.py [ROOT] [--limit 10]
"""

import argparse
import ast
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Iterator, List, Tuple

ROOT = Path(__file__).resolve().parents[2]
LONGEST_CLASS, LONGEST_FUNCTION, FULLEST_FOLDER = 200, 40, 16


@dataclass(frozen=True)
class Piece:
    """A class or a function with its number of lines, with decorators and without docstrings."""

    place: str
    name: str
    lines: int

    def __str__(self) -> str:
        return f"{self.lines:5d}  {self.name}  {self.place}"


def modules(root: Path) -> List[Path]:
    """Return the modules of all packages without tests and tutorials."""
    found = (path for path in root.glob("src/**/src/**/*.py") if "tutorials" not in path.parts)
    return sorted(path for path in found if "test" not in path.parts)


def pieces(root: Path) -> Tuple[List[Piece], List[Piece]]:
    """Return all classes and all functions, the longest first."""
    classes: List[Piece] = []
    functions: List[Piece] = []
    for path in modules(root):
        place = str(path.relative_to(root))
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef):
                classes.append(_piece(place, node))
            elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                functions.append(_piece(place, node))
    for found in (classes, functions):
        found.sort(key=lambda piece: -piece.lines)
    return classes, functions


def _piece(place: str, node) -> Piece:
    first = min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)])
    return Piece(place, node.name, node.end_lineno - first + 1 - _docstring_lines(node))


def _docstring_lines(node: ast.AST) -> int:
    """Lines of the docstrings within a class or a function: they explain, and are not counted as code."""
    kinds = (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    documented = [inner for inner in ast.walk(node) if isinstance(inner, kinds) and ast.get_docstring(inner)]
    return sum(len(ast.get_docstring(inner, clean=False).splitlines()) for inner in documented)  # type: ignore


def folders(root: Path) -> Counter:
    """Count the modules of each folder without ``__init__.py``."""
    return Counter(str(path.parent.relative_to(root)) for path in modules(root) if path.name != "__init__.py")


def too_long(found: List[Piece], limit: int) -> Iterator[Piece]:
    return (piece for piece in found if piece.lines > limit)


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "root", nargs="?", type=Path, default=ROOT, metavar="ROOT", help="a checkout (default: this)"
    )
    parser.add_argument("--limit", type=int, default=10, help="rows of each list (%(default)s)")
    options = parser.parse_args()
    if not (options.root / "src").is_dir():
        parser.error(f"{options.root} is not a workspace: it has no folder src")
    classes, functions = pieces(options.root)
    full = folders(options.root)
    size = f"{sum(full.values())} modules in {len(full)} folders"
    print(f"{size}, {len(classes)} classes, {len(functions)} functions")
    crowded = sum(number > FULLEST_FOLDER for number in full.values())
    print(f"\nfullest folders ({crowded} over {FULLEST_FOLDER} modules)")
    for folder, count in full.most_common(options.limit):
        print(f"{count:5d}  {folder}")
    for title, found, limit in (
        ("classes", classes, LONGEST_CLASS),
        ("functions", functions, LONGEST_FUNCTION),
    ):
        print(f"\nlongest {title} ({len(list(too_long(found, limit)))} over {limit} lines)")
        for piece in found[: options.limit]:
            print(piece)
    return 0


if __name__ == "__main__":
    sys.exit(main())
