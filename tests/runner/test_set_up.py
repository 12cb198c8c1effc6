"""The steps of scripts/setup.sh, in a workspace of their own."""

import fcntl
import shutil
import subprocess
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


def test_clearing_the_build_leaves_a_project_that_runs_alone(tmp_path):
    shutil.copytree(SCRIPTS, tmp_path / "scripts")
    kept, old, others = (tmp_path / "build" / name for name in ("projects/a", "projects/b", "planar"))
    for folder in (kept, old, others, tmp_path / "devel"):
        folder.mkdir(parents=True)
        (folder / "file").touch()
    with (kept / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        said = subprocess.check_output(
            ["bash", "-c", '. "$1"; clear_build', "bash", str(tmp_path / "scripts/setup.sh")], text=True
        )
    assert (kept / "file").exists()
    assert not old.exists() and not others.exists() and not (tmp_path / "devel").exists()
    assert f"in use: {kept}" in said
