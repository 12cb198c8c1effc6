"""Compiled kernels follow the sources of the kernels and classes they use."""

import subprocess
import sys

import pytest

from home_service.kernel_cache import discard_stale_kernels

CALLEE = """
from typing import NamedTuple

from numba import njit


class Limits(NamedTuple):
    highest: float


@njit(cache=True)
def scaled(value):
    return {factor} * value
"""
CALLER = """
from numba import njit

from arithmetic import Limits, scaled


@njit(cache=True)
def limited(value, limits):
    return min(scaled(value), limits.highest)
"""
PROGRAM = """
from arithmetic import Limits
from arithmetic.caller import limited

print(limited(1.0, Limits(100.0)))
"""


@pytest.fixture
def workspace(tmp_path):
    package = tmp_path / "src/arithmetic/src/arithmetic"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text("from arithmetic.callee import Limits, scaled\n")
    (package / "callee.py").write_text(CALLEE.format(factor=2.0))
    (package / "caller.py").write_text(CALLER)
    discard_stale_kernels(tmp_path)
    assert result_in(tmp_path) == "2.0"
    return tmp_path


def result_in(workspace, program=PROGRAM):
    (workspace / "program.py").write_text(program)
    run = subprocess.run(
        [sys.executable, str(workspace / "program.py")],
        env={"PYTHONPATH": str(workspace / "src/arithmetic/src")},
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stderr
    return run.stdout.strip()


def test_a_kernel_follows_an_edit_of_a_kernel_that_it_calls(workspace):
    # Of another size: within a second, Python takes an edited file of equal size for the old one.
    (workspace / "src/arithmetic/src/arithmetic/callee.py").write_text(CALLEE.format(factor=3.25))
    assert discard_stale_kernels(workspace) > 0
    assert result_in(workspace) == "3.25"


def test_a_kernel_follows_a_renamed_class_of_its_arguments(workspace):
    package = workspace / "src/arithmetic/src/arithmetic"
    for path in package.glob("*.py"):
        path.write_text(path.read_text().replace("Limits", "LimitsOfMotion"))
    assert discard_stale_kernels(workspace) > 0
    assert result_in(workspace, PROGRAM.replace("Limits", "LimitsOfMotion")) == "2.0"


def test_kernels_whose_sources_have_not_changed_are_kept(workspace):
    assert discard_stale_kernels(workspace) == 0
    (workspace / "src/arithmetic/src/arithmetic/other.py").write_text("FACTOR = 7\n")
    assert discard_stale_kernels(workspace) == 0


def test_a_damaged_record_discards_all_kernels(workspace):
    (workspace / "build/kernels.json").write_text("{")
    assert discard_stale_kernels(workspace) > 0
