#!/usr/bin/env python3
"""Writes src/*/config/*.yaml from the settings of packages, and pages of docs/; with --check only says
which are stale.
"""

import argparse
import importlib
import json
import sys
from pathlib import Path
from typing import Any, Dict, Iterable, List, Sequence

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(path) for path in ROOT.glob("src/*/src")]

from planar.config.listing import Section, rows_of, yaml_of  # noqa: E402

SCHEMA = ROOT / "src/home_service/config/result.schema.json"
MADE_BY = "Made by docs/generate.py; do not edit."


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--check", action="store_true", help="exit with 1 if a file is not as it would be written"
    )
    options = parser.parse_args()
    stale = {path: text for path, text in files().items() if not is_written(path, text)}
    for path, text in stale.items():
        name = path.relative_to(ROOT)
        if options.check:
            print(f"{name} is stale: run docs/generate.py", file=sys.stderr)
        else:
            path.write_text(text, encoding="utf-8")
            print(f"{name} written")
    return 1 if options.check and stale else 0


def is_written(path: Path, text: str) -> bool:
    return path.is_file() and path.read_text(encoding="utf-8") == text


def files() -> Dict[Path, str]:
    """Every file that is made from others, and its text."""
    declared = declared_files()
    return {
        **{path: f"# {MADE_BY}\n{yaml_of(section)}" for path, section in declared.items()},
        ROOT / "docs/parameters.md": parameters_page(declared),
        ROOT / "docs/result.md": result_page(),
    }


def declared_files() -> Dict[Path, Section]:
    """The YAML files that packages declare in their ``config`` (see planar.config.listing)."""
    found = {}
    for package in sorted(path.parent for path in ROOT.glob("src/*/config")):
        if (package / "src" / package.name / "config.py").is_file():
            module = importlib.import_module(f"{package.name}.config")
            for name, section in getattr(module, "CONFIG_FILES", {}).items():
                found[package / "config" / name] = section
    return found


def parameters_page(declared: Dict[Path, Section]) -> str:
    """Every parameter of every node: default, unit and meaning."""
    parts = [
        f"<!-- {MADE_BY} -->\n",
        "# Parameters\n",
        "Names are the official nodes' where they have them. A wrong type or a senseless value stops a node",
        "with the full name of the parameter; an unknown name is a warning that tells the nearest known one,",
        "and with `~strict_params: true` an error. Presets for robots lie beside; they hold what differs.\n",
    ]
    for path, section in sorted(declared.items()):
        package = path.parents[1].name
        if path.stem != package:
            continue
        presets = [other.name for other in sorted(path.parent.glob("*.yaml")) if other != path]
        parts.append(f"## {package}\n")
        parts.append(
            f"From [`{path.relative_to(ROOT)}`](../{path.relative_to(ROOT)})" + _presets(presets) + ".\n"
        )
        rows = [(_code(row.name), _code(row.value), row.unit, row.meaning) for row in rows_of(section)]
        parts.append(table(("parameter", "default", "unit", "meaning"), rows))
    return "\n".join(parts)


def _presets(names: List[str]) -> str:
    return f"; beside it {', '.join(f'`{name}`' for name in names)}" if names else ""


def result_page() -> str:
    """The keys of result.json, from its schema."""
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    rows = [(_code(name), _kind(field), field["description"]) for name, field in schema["properties"].items()]
    return "\n".join(
        [
            f"<!-- {MADE_BY} -->\n",
            "# result.json\n",
            schema["description"],
            f"The schema, for programs: [`{SCHEMA.name}`](../{SCHEMA.relative_to(ROOT)}).\n",
            table(("key", "type", "meaning"), rows),
        ]
    )


def _kind(field: Dict[str, Any]) -> str:
    kind = field["type"]
    if isinstance(kind, list):
        return " or ".join(kind)
    if kind == "array":
        return f"list of {field['items']['type']}s"
    return kind


def table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [_line(heads), _line(["---"] * len(heads)), *map(_line, rows)]
    return "\n".join(lines) + "\n"


def _line(cells: Sequence[str]) -> str:
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def _code(text: str) -> str:
    return f"`{text}`" if text else ""


if __name__ == "__main__":
    sys.exit(main())
