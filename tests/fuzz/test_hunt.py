"""The hunt under Atheris, which ./scripts/setup.sh --dev installs."""

import subprocess
import sys
from pathlib import Path

import pytest

HUNT = Path(__file__).parent / "hunt.py"


def test_a_reader_is_given_as_many_files_as_asked_for_and_goes_on_from_what_it_learnt(tmp_path):
    pytest.importorskip("atheris")
    command = [sys.executable, str(HUNT), "--reader", "zones", "--cases", "500", "--output", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300.0, check=False)
    assert done.stdout.splitlines() == ["zones: 500 files, 0 faults", "500 files, 0 faults"], done.stderr
    assert done.returncode == 0
    assert len(list((tmp_path / "corpus/zones").iterdir())) > 3


def test_senseless_limits_are_refused(tmp_path):
    for option in ("--cases", "--minutes"):
        done = subprocess.run(
            [sys.executable, str(HUNT), option, "0"],
            capture_output=True,
            text=True,
            timeout=60.0,
            check=False,
        )
        assert done.returncode == 2
        assert f"{option} must be positive" in done.stderr
