"""scripts/setup.sh, killed at random moments in a temporary workspace with stubs of its heavy steps."""

import contextlib
import ctypes
import os
import random
import shutil
import signal
import subprocess
import time
from hashlib import sha256
from pathlib import Path
from typing import Dict, Set, Tuple

import pytest

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
MOMENTS = 20
MODULES = ("a", "b", "c")
HEAVY_STEPS = """
    . "$1"
    missing_packages() { :; }
    missing_wheel() { :; }
    check_python() { :; }
    shield_rospy() { :; }
    kernel_inputs() { cat "$root/src/good/package.xml"; }
    warm_kernels() { sleep 0.05; }
    write_slowly() { # FOLDER TEXT: each file as a whole, as pip and catkin do
        local name
        mkdir -p "$1"
        for name in a b c setup.bash; do
            sleep 0.03
            print_line "$2" >"$1/$name.part"
            mv "$1/$name.part" "$1/$name"
        done
    }
    catkin_build() { write_slowly "$1/devel" "# $(cat "$root/src/good/package.xml")"; }
    python3() { :; }
    create_venv() { rm -rf "$venv" && mkdir -p "$venv/bin" && sleep 0.05 && maker >"$venv/.made"; }
    pip() {
        local file
        [[ $1 == install ]] || return 0
        for file in $requirements; do
            write_slowly "$venv/lib/python3.9/site-packages/$file" "$(sha256sum <"$root/scripts/$file")"
        done
        print_line "#!$venv/bin/python3" >"$venv/bin/tool.part"
        mv "$venv/bin/tool.part" "$venv/bin/tool"
    }
"""


class TemporaryWorkspace:
    def __init__(self, folder: Path):
        self.folder = folder
        shutil.copytree(SCRIPTS, folder / "scripts")
        (folder / "src/good").mkdir(parents=True)
        self.change("old")

    def change(self, version):
        (self.folder / "src/good/package.xml").write_text(f"<name>good</name> {version}")

    def start(self, commands):
        script = f"{HEAVY_STEPS}\n{commands}"
        return subprocess.Popen(
            ["bash", "-c", script, "bash", str(self.folder / "scripts/setup.sh")],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            text=True,
            env={name: value for name, value in os.environ.items() if name != "HOME_SERVICE_BUILD"},
        )

    def set_up(self, *extras):
        process = self.start(f"set_up {' '.join(extras)}")
        try:
            output, _ = process.communicate(timeout=60)
        except subprocess.TimeoutExpired as error:
            kill_session(process.pid, whole=True)
            raise AssertionError(f"the set-up hangs:\n{error.output!r}") from error
        assert process.returncode == 0, output

    def build(self, devel="devel"):
        """Return the version of a build; all its files have the same one."""
        (text,) = {(self.folder / devel / name).read_text() for name in (*MODULES, "setup.bash")}
        return text.split()[-1]

    def installed(self):
        """Return the requirement files that .venv holds in the version that it states."""
        venv = self.folder / ".venv"
        names = []
        for line in (venv / ".set-up").read_text().splitlines():
            digest, name = line.split()[:2]
            for module in MODULES:
                path = venv / "lib/python3.9/site-packages" / name / module
                assert path.read_text().split()[0] == digest, f"{name} is not whole"
            names.append(name)
        assert (venv / "bin/tool").read_text() == f"#!{venv}/bin/python3\n"
        return set(names)


@contextlib.contextmanager
def orphans_adopted():
    """Be the parent of processes whose parents end, without waiting for them."""
    prctl, set_child_subreaper = ctypes.CDLL(None).prctl, 36
    assert prctl(set_child_subreaper, 1, 0, 0, 0) == 0
    try:
        yield
    finally:
        prctl(set_child_subreaper, 0, 0, 0, 0)


def kill_session(leader, whole):
    """Kill the first process of a session, or all of them."""
    members = [leader]
    # Path.glob raises an error if a process ends while it looks.
    for name in filter(str.isdigit, os.listdir("/proc")) if whole else ():
        with contextlib.suppress(OSError):
            pid, _, rest = Path(f"/proc/{name}/stat").read_text().partition(" (")
            if int(rest.rpartition(") ")[2].split()[3]) == leader:
                members.append(int(pid))
    for member in members:
        with contextlib.suppress(ProcessLookupError):
            os.kill(member, signal.SIGKILL)


@pytest.mark.parametrize("moment", range(MOMENTS))
def test_a_set_up_that_is_killed_leaves_the_old_state_or_the_new_one(tmp_path, moment):
    chance = random.Random(moment)
    workspace = TemporaryWorkspace(tmp_path)
    workspace.set_up("cockpit")
    changes_packages = chance.random() < 0.5
    graph = None
    if changes_packages:
        with (tmp_path / "scripts/requirements.txt").open("a") as file:
            file.write("# changed\n")
    else:  # an extra and the build come while something runs
        graph = workspace.start("hold_build; echo $HOME_SERVICE_BUILD; exec sleep 60")
        held = graph.stdout.readline().strip()
    workspace.change("new")
    try:
        for attempt in range(2):
            killed = workspace.start("set_up cockpit gymnasium")
            time.sleep(chance.uniform(0.1, 1.2))
            kill_session(killed.pid, whole=chance.random() < 0.7)
            killed.wait()
            assert workspace.build() in ("old", "new"), attempt
            assert workspace.installed() >= {"requirements.txt", "requirements-cockpit.txt"}
            assert graph is None or workspace.build(held) == "old"
        workspace.set_up("cockpit", "gymnasium")
        assert workspace.build() == "new"
        assert workspace.installed() >= {
            f"requirements{extra}.txt" for extra in ("", "-cockpit", "-gymnasium")
        }
        assert graph is None or workspace.build(held) == "old"
        digest = sha256((tmp_path / "scripts/requirements.txt").read_bytes()).hexdigest()
        assert digest in (tmp_path / ".venv/.set-up").read_text()
    finally:
        if graph is not None:
            graph.kill()
            graph.communicate()


def test_a_set_up_goes_on_where_nobody_reaps_the_orphans_of_the_last_one(tmp_path):
    """As in a container whose first process is no init: what has ended stays in the table of processes."""
    workspace = TemporaryWorkspace(tmp_path)
    with orphans_adopted():
        slow = "install_python() { : >$root/begun; sleep 2; }"
        killed = workspace.start(f"{slow}; set_up")
        for line in killed.stdout:
            if line.startswith("Python packages"):
                break  # what remains is to wait for them
        assert (tmp_path / "begun").exists()
        time.sleep(0.2)
        kill_session(killed.pid, whole=False)
        workspace.set_up()
    assert workspace.installed() == {"requirements.txt"}


def test_packages_do_not_change_while_something_runs_in_the_workspace(tmp_path):
    workspace = TemporaryWorkspace(tmp_path)
    workspace.set_up()
    with (tmp_path / "scripts/requirements.txt").open("a") as file:
        file.write("# changed\n")
    graph = workspace.start("hold_build; echo held; exec sleep 60")
    try:
        assert graph.stdout.readline() == "held\n"
        before = (tmp_path / ".venv/.set-up").read_text()
        process = workspace.start("patience=1; set_up")
        output, _ = process.communicate(timeout=60)
        assert process.returncode == 1
        assert "Waiting for what runs in this workspace to end, as its Python packages change" in output
        assert output.endswith(
            "error: the Python packages have changed: end what runs in this workspace, then start again\n"
        )
        assert (tmp_path / ".venv/.set-up").read_text() == before
    finally:
        graph.kill()
        graph.communicate()
    workspace.set_up()
    assert (tmp_path / ".venv/.set-up").read_text() != before


def test_a_package_that_was_installed_by_half_is_installed_again(tmp_path):
    workspace = TemporaryWorkspace(tmp_path)
    packages = tmp_path / ".venv/lib/python3.9/site-packages"
    for name in ("half", "whole"):
        (packages / f"{name}.dist-info").mkdir(parents=True)
    (packages / "whole.dist-info/INSTALLER").touch()
    process = workspace.start("remove_half_installed")
    assert process.communicate(timeout=60) == ("", None)
    assert [path.name for path in packages.iterdir()] == ["whole.dist-info"]


def test_no_two_extras_ask_for_different_versions_of_a_package():
    """One that is installed must not change what another has installed."""
    pins: Dict[Tuple[str, str], Set[str]] = {}
    for path in SCRIPTS.glob("requirements*.txt"):
        for line in path.read_text().splitlines():
            requirement, _, marker = line.partition("#")[0].partition(";")
            name, is_pinned, version = requirement.strip().partition("==")
            if is_pinned and path.name != "requirements-wheel.txt":
                pins.setdefault((name.lower(), marker.strip()), set()).add(version)
    assert {pin: versions for pin, versions in pins.items() if len(versions) > 1} == {}
