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


def test_the_lock_of_a_set_up_ends_before_what_was_asked_for_is_run(tmp_path):
    shutil.copytree(SCRIPTS, tmp_path / "scripts")
    without_work = """
        . "$1"
        look_for_missing() { packages='' requirements='' build=workspace kernels=''; }
        announce() { :; }
        build_workspace() { :; }
        set_up
        exec sleep 20
    """
    script = tmp_path / "scripts/setup.sh"
    run = subprocess.Popen(["bash", "-c", without_work, "bash", str(script)])
    try:
        subprocess.run(
            ["bash", "-c", f"until [[ $(</proc/{run.pid}/comm) == sleep ]]; do :; done"], timeout=10
        )
        with script.open() as lock:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    finally:
        run.kill()
        run.wait()
