#!/usr/bin/env python3
"""Write what follows from the code and from tables.

These are src/*/config/*.yaml, scripts/usage, packages in src/compat and generated parts of pages in docs/.

A page has two kinds of generated parts: the source behind a comment that names a module, and the table or
text between ``<!-- generated: NAME -->`` and ``<!-- end -->``. With --check, only name the stale files.
"""

import argparse
import ast
import importlib
import re
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Callable, Dict, Iterator, List, Tuple

ROOT = Path(__file__).resolve().parents[1]
PLACES = ("src/*/src", "src/compat/*/src", "tests/fuzz", "tests/runner")
sys.path[:0] = [str(path) for place in PLACES for path in ROOT.glob(place)]

from alias_packages import alias_packages  # noqa: E402

from planar.config.config_file import Section, render_yaml  # noqa: E402
from supervision.command_line import usage  # noqa: E402

MADE_BY = "Made by docs/generate.py; do not edit."
# A comment that names a module, on a separate line, and the listing behind it, once there is one.
LISTING = re.compile(r"^<!-- (\S+\.py) -->\n(?:\n```python\n.*?^```\n)?", re.MULTILINE | re.DOTALL)
GENERATED = re.compile(r"^<!-- generated: (\w+) -->\n.*?^<!-- end -->$", re.MULTILINE | re.DOTALL)
USAGE = re.compile(r"^(# Usage: .*?)^(?!#)", re.MULTILINE | re.DOTALL)


def main() -> int:
    """Write the stale files, or name them. Return 1 if ``--check`` finds one."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="exit with 1 if a file is stale")
    options = parser.parse_args()
    stale = {path: text for path, text in files().items() if not is_written(path, text)}
    for path, text in stale.items():
        name = path.relative_to(ROOT)
        if options.check:
            print(f"{name} is stale: run docs/generate.py", file=sys.stderr)
        else:
            write(path, text)
            print(f"{name} written")
    return 1 if options.check and stale else 0


def write(path: Path, text: str) -> None:
    """Write a file; one that starts with ``#!`` becomes executable."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    if text.startswith("#!"):
        path.chmod(0o755)


def is_written(path: Path, text: str) -> bool:
    """Return whether the file has this text already."""
    return path.is_file() and path.read_text(encoding="utf-8") == text


def files() -> Dict[Path, str]:
    """Return every generated or partly generated file with its text."""
    configs = {path: f"# {MADE_BY}\n{render_yaml(section)}" for path, section in declared_files().items()}
    pages = {path: with_generated(path.read_text("utf-8")) for path in ROOT.glob("docs/**/*.md")}
    version = re.search("<version>(.*)</version>", (ROOT / "src/planar/package.xml").read_text("utf-8"))
    aliases = alias_packages(ROOT / "src/compat", version[1])
    return {**configs, **usages(), **aliases, **pages}


def usages() -> Dict[Path, str]:
    """Return the usage of each script whose options are a dataclass."""
    kinds = dict(commands())
    return {
        ROOT / f"scripts/usage/{name}.txt": usage(kind, f"./scripts/{name}.sh")
        for name, kind in kinds.items()
    }


def commands() -> Iterator[Tuple[str, type]]:
    """Yield name and options of each script whose options are a dataclass."""
    for path in sorted(ROOT.glob("src/*/src/*/commands")):
        if path.parent.name != "home_service_gym" or find_spec("gymnasium"):
            folder = importlib.import_module(f"{path.parent.name}.commands").FOLDER
            yield from ((name, folder.find(name)) for name in folder.names())
    yield "run_project", importlib.import_module("run_project.options").ProjectOptions
    yield "fuzz", importlib.import_module("hunt").Fuzz
    yield "test", importlib.import_module("run_tests").Test


def with_generated(page: str) -> str:
    """Return a page with its generated parts as they follow from the code now."""
    page = LISTING.sub(lambda found: f"<!-- {found[1]} -->\n\n```python\n{code_of(found[1])}```\n", page)
    return GENERATED.sub(
        lambda found: f"<!-- generated: {found[1]} -->\n\n{PARTS[found[1]]()}\n<!-- end -->", page
    )


def code_of(name: str) -> str:
    """Return the source of a module."""
    return (ROOT / name).read_text("utf-8")


def scripts() -> str:
    """Return a section for each script: its usage, generated or from its head comment."""
    generated = {path.stem: path.read_text("utf-8") for path in ROOT.glob("scripts/usage/*.txt")}
    generated.update({path.stem: text for path, text in usages().items()})
    sections: List[str] = []
    for path in sorted(ROOT.glob("scripts/*.sh")):
        comment = USAGE.search(path.read_text("utf-8"))
        text = generated.get(path.stem) or (comment and re.sub("^# ?", "", comment[1], flags=re.MULTILINE))
        if text:
            sections.append(f"## {path.name}\n\n```text\n{text.strip()}\n```\n")
    return "\n".join(sections)


def faults() -> str:
    """Return a table of the kinds of faults."""
    from sim_bridge.faults import KINDS

    rows = ["| kind | what goes wrong | usual strength | survivable |", "| --- | --- | --- | --- |"]
    for name, kind in KINDS.items():
        summary = (kind.__doc__ or "").partition("\n")[0].rstrip(".")
        strength = f"{kind.strength[0]:g} {kind.unit}" if kind.unit else ""
        rows.append(f"| `{name}` | {summary} | {strength} | {'yes' if kind.survivable else 'no'} |")
    return "\n".join(rows) + "\n"


def aliases() -> str:
    """Return a table of the deprecated Python names and their replacements."""
    rows = ["| old | new |", "| --- | --- |"]
    for path in sorted(ROOT.glob("src/**/src/**/*.py")):
        text = path.read_text("utf-8")
        if "deprecated_names(" in text or "renamed_method(" in text:
            rows += [f"| `{old}` | `{new}` |" for old, new in aliases_of(path, ast.parse(text))]
    return "\n".join(rows) + "\n"


def aliases_of(path: Path, tree: ast.Module) -> Iterator[Tuple[str, str]]:
    """Yield the deprecated names that a module declares, with their replacements."""
    parts = path.with_suffix("").parts
    module = ".".join(parts[len(parts) - parts[::-1].index("src") :]).replace(".__init__", "")
    for call in ast.walk(tree):
        if isinstance(call, ast.Call) and getattr(call.func, "id", "") == "deprecated_names":
            for old, new in ast.literal_eval(call.args[1]).items():
                yield f"{module}.{old}", new.replace(":", ".") if ":" in new else f"{module}.{new}"
    for scope in ast.walk(tree):
        for line in scope.body if isinstance(scope, ast.ClassDef) else ():
            value = line.value if isinstance(line, ast.Assign) else None
            if isinstance(value, ast.Call) and getattr(value.func, "id", "") == "renamed_method":
                old, new = (ast.literal_eval(argument) for argument in value.args)
                yield f"{module}.{scope.name}.{old}()", f"{new}()"


PARTS: Dict[str, Callable[[], str]] = {"aliases": aliases, "faults": faults, "scripts": scripts}


def declared_files() -> Dict[Path, Section]:
    """Return the YAML files that packages declare in their ``config`` (see planar.config.config_file)."""
    found = {}
    for package in sorted(path.parent for path in ROOT.glob("src/*/config")):
        if (package / "src" / package.name / "config.py").is_file():
            module = importlib.import_module(f"{package.name}.config")
            for name, section in getattr(module, "CONFIG_FILES", {}).items():
                found[package / "config" / name] = section
    return found


if __name__ == "__main__":
    sys.exit(main())
