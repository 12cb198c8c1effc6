"""Links and scripts in the documentation exist."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
LINK = re.compile(r"\]\((?!https?:|#)([^)#\s]+)")
SCRIPT = re.compile(r"\./(?:scripts|docs|docker)/[\w.-]+")
# Fuzz inputs, old names, and tests that make up a page.
NOT_OURS = (":!tests/fuzz/corpus", ":!docs/upgrade.md", ":!*/test/*")
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
        assert usage.startswith("Usage: "), script


def test_every_page_that_is_mentioned_anywhere_exists():
    files = ["git", "grep", "-I", "-o", "-h", "-E", r"\bdocs/[A-Za-z0-9_./-]+\.md\b", "--", ".", *NOT_OURS]
    mentioned = subprocess.run(files, cwd=ROOT, check=True, capture_output=True, text=True).stdout.split()
    assert sorted(page for page in set(mentioned) if not (ROOT / page).exists()) == []
