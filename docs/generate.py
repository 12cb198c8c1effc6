#!/usr/bin/env python3
"""Writes the pages of docs/ that follow from other files; with --check only says which are stale."""

import argparse
import json
import re
import sys
from pathlib import Path
from typing import Any, Dict, List, NamedTuple

ROOT = Path(__file__).resolve().parents[1]
SCHEMA = ROOT / "src/home_service/config/result.schema.json"
MADE_BY = "<!-- Made by docs/generate.py; do not edit. -->\n"
KEY = re.compile(
    r"^(?P<indent> *)(?P<off># )?(?P<name>[A-Za-z_]\w*)(?P<colon>:)?(?P<value>[^#]*)(#(?P<comment>.*))?$"
)


class Entry(NamedTuple):
    """A parameter, or a table of some (then ``value`` is None)."""

    name: str
    value: str
    meaning: str


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--check", action="store_true", help="exit with 1 if a page is not as it would be written"
    )
    options = parser.parse_args()
    pages = {"parameters.md": parameters_page(), "result.md": result_page()}
    stale = [name for name, text in pages.items() if not is_written(ROOT / "docs" / name, text)]
    if options.check:
        for name in stale:
            print(f"docs/{name} is stale: run docs/generate.py", file=sys.stderr)
        return 1 if stale else 0
    for name in stale:
        (ROOT / "docs" / name).write_text(pages[name], encoding="utf-8")
        print(f"docs/{name} written")
    return 0


def is_written(path: Path, text: str) -> bool:
    return path.is_file() and path.read_text(encoding="utf-8") == text


def parameters_page() -> str:
    """Every parameter of every node, with default and meaning, from the commented YAML files."""
    parts = [
        MADE_BY,
        "# Parameters\n",
        "Names are the official nodes' where they have them. A wrong type or a senseless value stops a node",
        "with the full name of the parameter; an unknown name is a warning that tells the nearest known one,",
        "and with `~strict_params: true` an error. Presets for robots lie beside; they hold what differs.\n",
    ]
    for path in sorted(ROOT.glob("src/*/config/*.yaml")):
        package = path.parents[1].name
        if path.stem != package:
            continue
        presets = [other.name for other in sorted(path.parent.glob("*.yaml")) if other != path]
        parts.append(f"## {package}\n")
        parts.append(
            f"From [`{path.relative_to(ROOT)}`](../{path.relative_to(ROOT)})" + _presets(presets) + ".\n"
        )
        parts.append(table(("parameter", "default", "meaning"), entries(path.read_text(encoding="utf-8"))))
    return "\n".join(parts)


def _presets(names: List[str]) -> str:
    return f"; beside it {', '.join(f'`{name}`' for name in names)}" if names else ""


def entries(text: str) -> List[Entry]:
    """The parameters of a YAML file whose comments stand beside, above or, going on, below them."""
    found: List[Entry] = []
    above: List[str] = []
    tables: List[str] = []
    anchors: Dict[str, str] = {}
    for line in text.splitlines():
        continued = re.match(r"^\s{8,}# (.*)$", line)
        if continued and found:
            last = found.pop()
            found.append(last._replace(meaning=f"{last.meaning} {continued.group(1).strip()}"))
            continue
        if re.match(r"^#(?! [a-z_]+ +#)", line):
            above.append(line[1:].strip())
            continue
        match = KEY.match(line)
        if not match or not (match["colon"] or match["off"]):
            above = []
            continue
        depth = len(match["indent"]) // 2
        name, value = ".".join([*tables[:depth], match["name"]]), match["value"].strip()
        if (not value or value.startswith("&")) and not match["off"]:
            tables = [*tables[:depth], match["name"]]
            anchors[value[1:]] = name
        else:
            meaning = (match["comment"] or " ".join(above)).strip()
            if value.startswith("*"):
                value, meaning = "", f"the same keys and defaults as `{anchors[value[1:]]}`"
            found.append(Entry(name.replace(".", "/"), value, meaning))
        above = []
    return found


def result_page() -> str:
    """The keys of result.json, from its schema."""
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    rows = [Entry(name, _kind(field), field["description"]) for name, field in schema["properties"].items()]
    return "\n".join(
        [
            MADE_BY,
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


def table(heads, rows: List[Entry]) -> str:
    lines = ["| " + " | ".join(heads) + " |", "| --- | --- | --- |"]
    for row in rows:
        value = row.value if heads[1] == "type" else (f"`{row.value}`" if row.value else "")
        lines.append(f"| `{row.name}` | {_cell(value)} | {_cell(row.meaning)} |")
    return "\n".join(lines) + "\n"


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


if __name__ == "__main__":
    sys.exit(main())
