"""The usage texts of the scripts list the options of their commands."""

import re
import subprocess
from importlib.util import find_spec
from pathlib import Path

import pytest

from home_service import commands
from laboratory.commands import FOLDER as EXPERIMENTS
from supervision.cli import parse

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
FOLDERS = {"": commands.FOLDER, "experiments": EXPERIMENTS}
if find_spec("gymnasium"):
    from home_service_gym.commands import FOLDER as ENVIRONMENTS

    FOLDERS["environments"] = ENVIRONMENTS
OPTION = re.compile(r"--[a-z][a-z-]*")


@pytest.mark.parametrize(
    ("folder", "command"),
    [(folder, name) for folder in FOLDERS.values() for name in sorted(folder.names())],
)
def test_a_script_lists_the_options_of_its_command(folder, command, capsys):
    with pytest.raises(SystemExit):
        parse([command, "--help"], folder)
    usage = subprocess.run(
        [SCRIPTS / f"{command}.sh", "--help"], check=True, capture_output=True, text=True
    ).stdout
    assert set(OPTION.findall(usage)) == set(OPTION.findall(capsys.readouterr().out))


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


@pytest.mark.parametrize(("kind", "folder"), list(FOLDERS.items())[1:])
def test_a_script_of_another_package_is_registered(kind, folder):
    listed = re.search(rf"{kind}=\((.*?)\)", (SCRIPTS / "lib.sh").read_text())
    assert listed and sorted(listed[1].split()) == sorted(folder.names())
