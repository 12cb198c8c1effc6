"""The scripts run the commands of the packages, and print their usage on a machine without a set-up."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
COMMANDS = sorted(
    path for path in SCRIPTS.parent.glob("src/*/src/*/commands/*.py") if path.name != "__init__.py"
)


@pytest.mark.parametrize("command", COMMANDS, ids=lambda path: path.stem)
def test_every_command_has_a_script_that_runs_it_from_its_package(command):
    text = (SCRIPTS / f"{command.stem}.sh").read_text()
    assert text.endswith(f'run_command {command.parents[1].name} {command.stem} "$@"\n')


@pytest.mark.parametrize("script", sorted(SCRIPTS.glob("*.sh")), ids=lambda path: path.stem)
def test_a_script_prints_its_usage_without_packages_and_python(script, tmp_path):
    if script.stem in ("lib", "shell"):
        pytest.skip("is sourced")
    shutil.copytree(SCRIPTS, tmp_path / "scripts")
    programs = tmp_path / "programs"
    programs.mkdir()
    (programs / "python3").write_text("#!/bin/sh\nexit 1\n")
    (programs / "python3").chmod(0o755)
    environment = {"PATH": f"{programs}:/usr/bin:/bin"}
    copy = tmp_path / "scripts" / script.name
    result = subprocess.run([copy, "--help"], capture_output=True, text=True, env=environment)
    assert result.returncode == 0, result.stderr
    assert result.stdout.lower().startswith(f"usage: ./scripts/{script.name}")
    assert "--help" in result.stdout
    assert sorted(tmp_path.iterdir()) == [programs, tmp_path / "scripts"]


def test_a_script_that_cannot_write_temporary_files_fails_with_one_line(tmp_path):
    for limit, folder, reason in (("unlimited", tmp_path / "gone", "made"), ("1", tmp_path, "written")):
        command = f"trap '' XFSZ; ulimit -f {limit}; TMPDIR={folder} exec {SCRIPTS}/doctor.sh"
        result = subprocess.run(["bash", "-c", command], capture_output=True, text=True)
        assert result.returncode == 1
        assert re.fullmatch(
            rf"error: {folder}: no temporary files can be {reason} there \(.+\)\n", result.stderr
        )
    assert list(tmp_path.iterdir()) == []


def test_the_set_up_refuses_an_option_that_it_does_not_know():
    result = subprocess.run([SCRIPTS / "setup.sh", "--nonsense"], capture_output=True, text=True)
    assert result.returncode == 2
    assert "--nonsense" in result.stderr
