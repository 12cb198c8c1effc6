"""The worked examples of docs/explanation/architecture.md run, word for word, in a copy of the tree."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import List, NamedTuple

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/explanation/architecture.md"
EXAMPLE = re.compile(r"^### (How to add [^\n]*)\n(.*?)(?=^##|\Z)", re.MULTILINE | re.DOTALL)
BLOCK = re.compile(r'^```(\w+)(?: title="([^"\n]*)")?\n(.*?)^```$', re.MULTILINE | re.DOTALL)
MOST_CHANGED = 2
RUN_SECONDS = 300.0


class Block(NamedTuple):
    """A block of code of the page: a new file by its title, a change as a diff, or a script to run."""

    language: str
    title: str
    text: str


class Example(NamedTuple):
    name: str
    blocks: List[Block]

    def of(self, language: str) -> List[Block]:
        return [block for block in self.blocks if block.language == language]


def examples() -> List[Example]:
    page = PAGE.read_text(encoding="utf-8")
    return [
        Example(name, [Block(*block) for block in BLOCK.findall(text)])
        for name, text in EXAMPLE.findall(page)
    ]


@pytest.fixture
def tree(tmp_path):
    """A copy of the folders that examples change, with the compiled kernels."""
    for name in ("src", "map", "docs", "scripts", "tests/fuzz", "tests/runner"):
        shutil.copytree(ROOT / name, tmp_path / name, symlinks=True)
    return tmp_path


def test_the_page_has_examples_of_a_planner_a_check_an_extension_point_a_sensor_a_command_and_a_result():
    names = " ".join(example.name for example in examples())
    needed = ("planner", "check", "extension point", "sensor", "command", "result.json")
    assert all(word in names for word in needed), names


@pytest.mark.parametrize("example", examples(), ids=lambda example: example.name)
def test_an_example_works_as_it_is_written(example, tree):
    assert len({block.title for block in example.of("diff")}) <= MOST_CHANGED
    for block in example.of("python"):
        if block.title:
            path = tree / block.title
            assert not path.exists(), f"{block.title} exists"
            path.write_text(block.text, encoding="utf-8")
    for block in example.of("diff"):
        change(tree / block.title, block.text)
    scripts = [block for block in example.of("python") if not block.title]
    assert scripts, "no script checks the example"
    for block in scripts:
        run(block.text, tree)


def change(path: Path, difference: str) -> None:
    """Apply each hunk of a diff, separated by ``@@``; its context must occur exactly once in the file."""
    text = path.read_text(encoding="utf-8")
    for hunk in re.split(r"^@@.*\n", difference, flags=re.MULTILINE):
        lines = hunk.splitlines(keepends=True)
        before = "".join(line[1:] for line in lines if not line.startswith("+"))
        after = "".join(line[1:] for line in lines if not line.startswith("-"))
        assert text.count(before) == 1, f"not exactly once in {path.name}:\n{before}"
        text = text.replace(before, after)
    path.write_text(text, encoding="utf-8")


def run(script: str, tree: Path) -> None:
    """Run Python in the copy of the tree; fail with its output."""
    packages = sorted(str(path) for path in tree.glob("src/**/src") if path.is_dir())
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([*packages, os.environ.get("PYTHONPATH", "")])}
    result = subprocess.run(
        [sys.executable, "-"],
        input=script,
        cwd=tree,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=RUN_SECONDS,
        text=True,
        check=False,
    )
    assert result.returncode == 0, result.stdout
