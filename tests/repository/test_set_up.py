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


def in_workspace(folder, commands):
    """What the commands print, after the functions of the set-up are there, in a workspace of its own."""
    if not (folder / "scripts").exists():
        shutil.copytree(SCRIPTS, folder / "scripts")
        (folder / "logs/setup").mkdir(parents=True)
    return subprocess.run(
        ["bash", "-c", f'. "$1"; cd "$root"; {commands}', "bash", str(folder / "scripts/setup.sh")],
        capture_output=True,
        text=True,
    )


def write_package(folder, name):
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text(f"<package>\n  <name>{name}</name>\n</package>\n")


def set_up_once(folder):
    """A workspace whose build went well."""
    write_package(folder / "src/good", "good")
    built = in_workspace(
        folder,
        """
        catkin_build() { mkdir -p build devel; echo good | tee devel/setup.bash >build/cache; }
        retry=''; look_for_missing; build_workspace
        """,
    )
    assert built.returncode == 0, built.stderr


FAILING = """
    catkin_build() {
        echo half >devel/setup.bash
        printf '%s\\n' 'CMake Error at /usr/share/catkin/cmake/catkinConfig.cmake:83 (find_package):' \\
            '  Could not find a package configuration file provided by "roscpp" with any of' \\
            'Call Stack (most recent call first):' '  mine/CMakeLists.txt:10 (find_package)'
        return 1
    }
    missing_requirements() { :; }
    missing_packages() { :; }
    announce() { :; }
    compile_kernels() { :; }
"""


def test_a_package_that_does_not_build_leaves_the_last_good_build_in_use(tmp_path):
    set_up_once(tmp_path)
    write_package(tmp_path / "src/mine", "mine")
    for _ in range(2):  # the second time it is told, but not built again
        said = in_workspace(tmp_path, FAILING + "set_up; echo used")
        assert said.returncode == 0, said.stderr
        assert said.stdout.endswith("used\n")
        assert "warning: the package 'mine' does not build: it needs roscpp" in said.stderr
        assert (tmp_path / "devel/setup.bash").read_text() == "good\n"
        assert (tmp_path / "build/cache").read_text() == "good\n"
    assert "Building" not in said.stdout
    shutil.rmtree(tmp_path / "src/mine")
    said = in_workspace(tmp_path, FAILING + "set_up; echo used")
    assert said.stderr == "" and "Building" not in said.stdout


def test_the_set_up_itself_fails_on_a_package_that_does_not_build(tmp_path):
    set_up_once(tmp_path)
    write_package(tmp_path / "src/mine", "mine")
    for _ in range(2):
        said = in_workspace(tmp_path, FAILING + "main")
        assert said.returncode == 1
        assert "Building" in said.stdout
        assert "error: the package 'mine' does not build" in said.stderr


def test_a_build_that_was_cut_short_is_undone_by_the_next(tmp_path):
    set_up_once(tmp_path)
    in_workspace(tmp_path, "clear_build; mkdir devel; touch devel/half")
    assert not (tmp_path / "devel/setup.bash").exists()
    in_workspace(tmp_path, "restore_last_build")
    assert (tmp_path / "devel/setup.bash").read_text() == "good\n"
    assert not (tmp_path / "devel/half").exists() and not (tmp_path / "build/.last").exists()


def test_a_build_that_was_cut_short_while_it_was_set_aside_is_whole_again(tmp_path):
    set_up_once(tmp_path)
    in_workspace(tmp_path, 'mkdir -p "$last/build"; mv build/cache build/.set-up "$last/build"')
    in_workspace(tmp_path, "restore_last_build")
    assert (tmp_path / "devel/setup.bash").exists()
    assert (tmp_path / "build/cache").exists() and (tmp_path / "build/.set-up").exists()


def test_a_package_of_the_user_takes_the_place_of_a_tutorial(tmp_path):
    write_package(tmp_path / "src/tutorials/learning_topic", "learning_topic")
    write_package(tmp_path / "src/course/learning_topic", "learning_topic")
    said = in_workspace(tmp_path, "ignored_packages; check_names")
    assert said.stdout.splitlines() == [
        "src/tutorials/learning_topic",
        "your package 'learning_topic' takes the place of the project's own",
    ]


def test_two_packages_of_one_name_are_refused_in_a_sentence(tmp_path):
    write_package(tmp_path / "src/planar", "planar")
    write_package(tmp_path / "src/mine/planar", "planar")
    said = in_workspace(tmp_path, "check_names")
    assert said.returncode == 1
    assert "two packages are named 'planar' (src/mine/planar and src/planar)" in said.stderr


def test_what_is_no_fault_of_the_project_is_told_in_a_sentence(tmp_path):
    for line, sentence in {
        "OSError: [Errno 28] No space left on device": "the disk is full",
        "Temporary failure resolving 'deb.debian.org'": "no network",
        "urllib3.exceptions.IncompleteRead": "a download broke off",
    }.items():
        (tmp_path / "log").write_text(f"Collecting numpy\n{line}\n")
        said = in_workspace(tmp_path, "give_up 'pip failed' log")
        assert said.returncode == 1
        assert said.stderr.startswith(f"error: {sentence}")


def test_a_half_built_wheel_never_reaches_the_cache(tmp_path):
    said = in_workspace(
        tmp_path,
        f'wheels={tmp_path}/cache; pip_of() {{ touch "$work/pybullet-half.whl"; return 1; }}; build_wheel',
    )
    assert said.returncode == 1
    assert list((tmp_path / "cache").iterdir()) == []
