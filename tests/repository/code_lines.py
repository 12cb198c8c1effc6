#!/usr/bin/env python3
"""Count the lines of Python of a checkout: code, docstrings, comments and blank lines.

python3 tests/repository/code_lines.py [--root DIR] [--packages]
"""

import argparse
import ast
import io
import tokenize
from pathlib import Path
from typing import Counter, Dict, Sequence, Set

ROOT = Path(__file__).resolve().parents[2]
KINDS = ("files", "lines", "code", "docstrings", "comments", "blank")
LAYOUT = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT}
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def count(text: str) -> Counter[str]:
    """Count the lines of a module by kind; a line with code and a comment is code."""
    lines = text.splitlines()
    docstrings = docstring_lines(ast.parse(text))
    code = numbers_of_code(text)
    tokens = tokenize.generate_tokens(io.StringIO(text).readline)
    comments = {token.start[0] for token in tokens if token.type == tokenize.COMMENT} - code
    blank = len(lines) - len(code | docstrings | comments)
    numbers = (1, len(lines), len(code), len(docstrings), len(comments), blank)
    return Counter(dict(zip(KINDS, numbers)))


def numbers_of_code(text: str) -> Set[int]:
    """Return the numbers of the lines with code: neither docstrings nor only comments."""
    code: Set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in LAYOUT and token.string:
            code.update(range(token.start[0], token.end[0] + 1))
    return code - docstring_lines(ast.parse(text))


def docstring_lines(tree: ast.Module) -> Set[int]:
    """Return the numbers of the lines that docstrings occupy."""
    found: Set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, DOCUMENTED) and ast.get_docstring(node, clean=False) is not None:
            first = node.body[0]
            found.update(range(first.lineno, (first.end_lineno or first.lineno) + 1))
    return found


def part_of(path: Path) -> str:
    """Return the row that a file belongs to; ``path`` is relative to the root."""
    if path.parts[0] == "src":
        return "src, tests" if "test" in path.parts else "src"
    return path.parts[0]


def table(root: Path, by_package: bool) -> str:
    """Return the table of a checkout: a row for each part or, of src without tests, each package."""
    rows: Dict[str, Counter[str]] = {}
    for path in sorted(
        path for folder in ("src", "tests", "docs") for path in root.glob(f"{folder}/**/*.py")
    ):
        place = path.relative_to(root)
        name = part_of(place)
        if by_package:
            if name != "src":
                continue
            name = "/".join(place.parts[1 : 3 if place.parts[1] in ("compat", "tutorials") else 2])
        rows.setdefault(name, Counter()).update(count(path.read_text(encoding="utf-8")))
    width = max(map(len, rows), default=0)
    return "\n".join(
        [_row("", KINDS, width), *(_row(name, [rows[name][kind] for kind in KINDS], width) for name in rows)]
    )


def _row(name: str, cells: Sequence[object], width: int) -> str:
    return f"{name:<{width}}" + "".join(f"{cell:>12}" for cell in cells)


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--root", type=Path, default=ROOT, help="the checkout (default: this one)")
    parser.add_argument("--packages", action="store_true", help="a row for each package, without tests")
    options = parser.parse_args()
    print(table(options.root, options.packages))


if __name__ == "__main__":
    main()
