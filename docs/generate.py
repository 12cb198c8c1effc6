#!/usr/bin/env python3
"""Write src/*/config/*.yaml from the settings of packages, and code into docs/how_to/examples/*.md.

With --check only says which are stale.
"""

import argparse
import importlib
import re
import sys
from pathlib import Path
from typing import Dict

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(path) for path in ROOT.glob("src/*/src")]

from planar.config.listing import Section, render_yaml  # noqa: E402

MADE_BY = "Made by docs/generate.py; do not edit."
# A comment that names a module, on a line of its own, and the listing behind it, once there is one.
LISTING = re.compile(r"^<!-- (\S+\.py) -->\n(?:\n```python\n.*?^```\n)?", re.MULTILINE | re.DOTALL)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
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
    """Every file that is made, in whole or in part, and its text."""
    configs = {path: f"# {MADE_BY}\n{render_yaml(section)}" for path, section in declared_files().items()}
    pages = {path: with_listings(path.read_text("utf-8")) for path in ROOT.glob("docs/how_to/examples/*.md")}
    return {**configs, **pages}


def with_listings(page: str) -> str:
    """A page, with the code as it is now behind each comment that names a module."""
    return LISTING.sub(lambda found: f"<!-- {found[1]} -->\n\n```python\n{code_of(found[1])}```\n", page)


def code_of(name: str) -> str:
    return (ROOT / name).read_text("utf-8")


def declared_files() -> Dict[Path, Section]:
    """The YAML files that packages declare in their ``config`` (see planar.config.listing)."""
    found = {}
    for package in sorted(path.parent for path in ROOT.glob("src/*/config")):
        if (package / "src" / package.name / "config.py").is_file():
            module = importlib.import_module(f"{package.name}.config")
            for name, section in getattr(module, "CONFIG_FILES", {}).items():
                found[package / "config" / name] = section
    return found


if __name__ == "__main__":
    sys.exit(main())
