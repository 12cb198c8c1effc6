"""Fuzzing under Atheris, which ./scripts/setup.sh --dev installs."""

import subprocess
import sys
from pathlib import Path

import pytest

HUNT = Path(__file__).parent / "hunt.py"


def test_a_reader_is_given_the_requested_number_of_files_and_extends_its_corpus(tmp_path):
    pytest.importorskip("atheris")
    command = [sys.executable, str(HUNT), "--reader", "zones", "--cases", "500", "--output", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300.0, check=False)
    assert done.stdout.splitlines() == ["zones: 500 files, 0 faults", "500 files, 0 faults"], done.stderr
    assert done.returncode == 0
    assert len(list((tmp_path / "corpus/zones").iterdir())) > 3


def test_limits_that_are_not_positive_are_rejected(tmp_path):
    for option in ("--cases", "--minutes"):
        done = subprocess.run(
            [sys.executable, str(HUNT), option, "0"],
            capture_output=True,
            text=True,
            timeout=60.0,
            check=False,
        )
        assert done.returncode == 2
        assert f"argument {option}: " in done.stderr
