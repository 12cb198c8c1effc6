"""Links and scripts in the documentation exist."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LINK = re.compile(r"\]\((?!https?:|#)([^)#\s]+)")
SCRIPT = re.compile(r"\./(?:scripts|docs|docker)/[\w.-]+")
MENTIONED = re.compile(r"\bdocs/[\w./-]+\.md\b")
FOLDERS = ("docker", "docs", "map", "scenarios", "scripts", "src", "tests")
SUFFIXES = {".py", ".md", ".yaml", ".sh", ".launch", ".srv", ".msg", ".action", ""}
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_link_and_every_script_of_a_page_exists(page):
    text = page.read_text(encoding="utf-8")
    missing = [link for link in LINK.findall(text) if not (page.parent / link).exists()]
    missing += [script for script in SCRIPT.findall(text) if not (ROOT / script).exists()]
    assert not missing


def test_every_script_of_the_readme_has_a_help_text():
    for script in sorted(
        set(re.findall(r"\./scripts/\w+\.sh", (ROOT / "README.md").read_text(encoding="utf-8")))
    ):
        usage = subprocess.run([ROOT / script, "--help"], check=True, capture_output=True, text=True).stdout
        assert usage.startswith(("Usage: ", "usage: ")), script


def test_every_page_that_is_mentioned_in_the_tree_exists():
    missing = set()
    for path in (path for folder in FOLDERS for path in (ROOT / folder).rglob("*")):
        is_other = {"corpus", "test", "__pycache__"} & set(path.parts) or path.name == "upgrade.md"
        if path.suffix in SUFFIXES and path.is_file() and not is_other:
            pages = MENTIONED.findall(path.read_text(encoding="utf-8", errors="replace"))
            missing |= {(str(path.relative_to(ROOT)), page) for page in pages if not (ROOT / page).exists()}
    assert not missing
