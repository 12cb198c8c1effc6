"""The steps of scripts/setup.sh in a temporary workspace."""

import fcntl
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


def test_clearing_projects_of_the_last_build_leaves_one_that_runs_alone(tmp_path):
    shutil.copytree(SCRIPTS, tmp_path / "scripts")
    kept, old = (tmp_path / "build/projects" / name for name in "ab")
    for folder in (kept, old):
        folder.mkdir(parents=True)
        (folder / "file").touch()
    with (kept / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        output = subprocess.check_output(
            ["bash", "-c", '. "$1"; clear_projects', "bash", str(tmp_path / "scripts/setup.sh")], text=True
        )
    assert (kept / "file").exists()
    assert not old.exists()
    assert f"in use: {kept}" in output


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
    """Run shell commands with the functions of the set-up in a temporary workspace."""
    if not (folder / "scripts").exists():
        shutil.copytree(SCRIPTS, folder / "scripts")
        (folder / "logs/setup").mkdir(parents=True)
    return subprocess.run(
        ["bash", "-c", f'. "$1"; cd "$root"; {commands}', "bash", str(folder / "scripts/setup.sh")],
        capture_output=True,
        text=True,
        timeout=60,
    )


VALID = """<version>1.0.0</version><description>one</description><license>MIT</license>
  <maintainer email="a@b.org">a</maintainer>"""


def write_package(folder, name, content=""):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "package.xml").write_text(f"<package>\n  <name>{name}</name>\n  {content}\n</package>\n")


def set_up_once(folder):
    """A workspace whose build went well."""
    write_package(folder / "src/good", "good")
    built = in_workspace(
        folder,
        """
        catkin_build() {
            mkdir -p "$1"/{build,devel}
            echo good | tee "$1/devel/setup.bash" >"$1/build/cache"
        }
        retry=''; look_for_missing; build_workspace
        """,
    )
    assert built.returncode == 0, built.stderr


FAILING = """
    catkin_build() {
        mkdir -p "$1/devel"; echo half >"$1/devel/setup.bash"
        printf '%s\\n' 'CMake Warning at /usr/share/genmsg/cmake/genmsg-extras.cmake:49 (message):' \\
            '  Unknown message generator' \\
            'Call Stack (most recent call first):' '  other/CMakeLists.txt:5 (find_package)' \\
            'CMake Error at /usr/share/catkin/cmake/catkinConfig.cmake:83 (find_package):' \\
            '  Could not find a package configuration file provided by "roscpp" with any of' \\
            'Call Stack (most recent call first):' '  mine/CMakeLists.txt:10 (find_package)'
        return 1
    }
    missing_requirements() { :; }
    missing_packages() { :; }
    announce() { :; }
    warm_kernels() { :; }
"""


def test_a_package_that_does_not_build_leaves_the_last_good_build_in_use(tmp_path):
    set_up_once(tmp_path)
    write_package(tmp_path / "src/mine", "mine")
    for _ in range(2):  # the second run reports it without building again
        result = in_workspace(tmp_path, FAILING + "set_up; echo used")
        assert result.returncode == 0, result.stderr
        assert result.stdout.endswith("used\n")
        assert (
            "warning: the package 'mine' does not build: it needs roscpp, which is not installed "
            "(./scripts/setup.sh --projects installs what most packages in C++ need)"
        ) in result.stderr
        assert (tmp_path / "devel/setup.bash").read_text() == "good\n"
        assert (tmp_path / "devel/../build/cache").read_text() == "good\n"
    assert "Building" not in result.stdout
    shutil.rmtree(tmp_path / "src/mine")
    result = in_workspace(tmp_path, FAILING + "set_up; echo used")
    assert result.stderr == "" and "Building" not in result.stdout


def test_ros_does_not_meet_an_invalid_package_while_the_last_build_is_in_use(tmp_path):
    set_up_once(tmp_path)
    write_package(tmp_path / "src/good", "good", VALID)
    write_package(tmp_path / "src/good/lent/rviz", "rviz", VALID)  # catkin does not look into packages
    write_package(tmp_path / "src/ignored", "ignored", VALID)
    (tmp_path / "src/ignored/CATKIN_IGNORE").touch()
    well = "catkin_build() { mkdir -p $1/devel; printf %s $root/src >$1/devel/.catkin; }"
    in_workspace(tmp_path, f"{well}; retry=''; look_for_missing; build_workspace")
    write_package(tmp_path / "src/nested/mine", "mine", VALID.replace("a@b.org", "nobody"))
    result = in_workspace(tmp_path, FAILING + "set_up; echo used")
    assert result.stdout.endswith("used\n"), result.stderr
    assert (tmp_path / "devel/.catkin").read_text() == f"{tmp_path}/src/good"
    shutil.rmtree(tmp_path / "src/nested")
    in_workspace(tmp_path, FAILING + "set_up")
    assert (tmp_path / "devel/.catkin").read_text() == f"{tmp_path}/src"


def test_a_package_xml_that_is_no_text_does_not_affect_other_packages(tmp_path):
    set_up_once(tmp_path)
    write_package(tmp_path / "src/good", "good", VALID)
    in_workspace(
        tmp_path, "catkin_build() { mkdir -p $1/devel; }; retry=''; look_for_missing; build_workspace"
    )
    (tmp_path / "devel/.catkin").write_text(f"{tmp_path}/src")
    write_package(tmp_path / "src/mine", "mine", VALID)
    with (tmp_path / "src/mine/package.xml").open("ab") as manifest:
        manifest.write(b"\xff\xfe")
    result = in_workspace(tmp_path, FAILING + "set_up; echo used")
    assert result.stdout.endswith("used\n"), result.stderr
    assert (tmp_path / "devel/.catkin").read_text() == f"{tmp_path}/src/good"


def test_the_set_up_itself_fails_on_a_package_that_does_not_build(tmp_path):
    set_up_once(tmp_path)
    write_package(tmp_path / "src/mine", "mine")
    for _ in range(2):
        result = in_workspace(tmp_path, FAILING + "main")
        assert result.returncode == 1
        assert "Building" in result.stdout
        assert "error: the package 'mine' does not build" in result.stderr


BUILD_AGAIN = "missing_packages() { :; }; retry=''; look_for_missing; build_workspace"


def test_a_build_that_was_cut_short_is_made_again_beside_the_last_good_one(tmp_path):
    set_up_once(tmp_path)
    cut = 'catkin_build() { mkdir -p "$1/devel"; touch "$1/devel/half"; kill -KILL $$; }; '
    in_workspace(tmp_path, cut + BUILD_AGAIN)
    assert (tmp_path / "build/2/devel/half").exists()
    assert (tmp_path / "devel/setup.bash").read_text() == "good\n"
    whole = 'catkin_build() { mkdir -p "$1/devel"; echo new >"$1/devel/setup.bash"; }; '
    in_workspace(tmp_path, whole + BUILD_AGAIN)
    assert (tmp_path / "devel/setup.bash").read_text() == "new\n"
    assert not (tmp_path / "devel/half").exists()


def test_a_script_keeps_the_build_that_it_started_with_and_so_do_those_that_it_starts(tmp_path):
    set_up_once(tmp_path)
    outer = in_workspace(
        tmp_path,
        """
        build() {
            echo "export ROUND=$1" >round
            bash -c '. "$1"
                catkin_build() { mkdir -p "$1/devel"; cp round "$1/devel/setup.bash"; }
                missing_packages() { :; }
                retry=
                look_for_missing
                build_workspace' bash "$root/scripts/setup.sh" 8<&-
        }
        inner() { bash -c '. "$1"; enter_workspace; echo $ROUND' bash "$root/scripts/setup.sh"; }
        build 1 >&2
        enter_workspace
        for round in 2 3 4; do
            env -u HOME_SERVICE_BUILD bash -c "$(declare -f build); root=$root; build $round" >&2
        done
        cat "$HOME_SERVICE_BUILD/setup.bash" devel/setup.bash
        inner
        """,
    )
    assert outer.stdout.split("\n") == ["export ROUND=1", "export ROUND=4", "1", ""], outer.stderr
    assert sorted(path.name for path in (tmp_path / "build").glob("[0-9]*")) == ["1", "2", "3"]


def test_what_a_running_script_starts_does_not_build_although_sources_have_changed(tmp_path):
    set_up_once(tmp_path)
    in_workspace(tmp_path, FAILING + "catkin_build() { false; }; main")
    write_package(tmp_path / "src/mine", "mine")
    result = in_workspace(tmp_path, FAILING + ": >devel/setup.bash; enter_workspace; set_up; echo used")
    assert result.stdout.endswith("used\n") and "Building" not in result.stdout
    assert result.stderr == (
        "warning: what runs in this workspace keeps its build; new ones come with the next start\n"
    )


def test_a_build_of_version_1_0_0_gives_way_to_the_next(tmp_path):
    for old in ("devel/setup.bash", "build/CMakeCache.txt", "build/planar/Makefile", "build/.set-up"):
        (tmp_path / old).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / old).touch()
    set_up_once(tmp_path)
    assert (tmp_path / "devel").is_symlink()
    assert (tmp_path / "devel/setup.bash").read_text() == "good\n"
    assert sorted(path.name for path in (tmp_path / "build").iterdir()) == ["1"]


def test_a_package_of_the_user_takes_the_place_of_a_tutorial(tmp_path):
    write_package(tmp_path / "src/tutorials/learning_topic", "learning_topic")
    write_package(tmp_path / "src/course/learning_topic", "learning_topic")
    result = in_workspace(tmp_path, "ignored_packages; check_names")
    assert result.stdout.splitlines() == [
        "src/tutorials/learning_topic",
        "your package 'learning_topic' takes the place of the project's own",
    ]


def test_two_packages_of_one_name_are_refused_in_a_sentence(tmp_path):
    write_package(tmp_path / "src/planar", "planar")
    write_package(tmp_path / "src/mine/planar", "planar")
    result = in_workspace(tmp_path, "check_names")
    assert result.returncode == 1
    assert "two packages are named 'planar' (src/mine/planar and src/planar)" in result.stderr


def test_a_failure_outside_the_project_is_reported_in_one_sentence(tmp_path):
    for line, sentence in {
        "OSError: [Errno 28] No space left on device": "the disk is full",
        "Temporary failure resolving 'deb.debian.org'": "no network",
        "urllib3.exceptions.IncompleteRead": "a download broke off",
    }.items():
        (tmp_path / "log").write_text(f"Collecting numpy\n{line}\n")
        result = in_workspace(tmp_path, "give_up 'pip failed' log")
        assert result.returncode == 1
        assert result.stderr.startswith(f"error: {sentence}")


def test_what_the_first_set_up_installs_does_not_make_the_second_start_build_again(tmp_path):
    result = in_workspace(
        tmp_path,
        FAILING
        + """
        mkdir src
        build_inputs() { cat python 2>/dev/null; echo; }
        missing_packages() { [[ -e python ]] || echo python3; }
        check_place() { :; }
        install_debian() { echo 3.13 >python; }
        catkin_build() { mkdir -p $1/devel; }
        set_up
        look_for_missing
        echo "left: $build"
        """,
    )
    assert result.stdout.endswith("left: \n"), result.stderr


def test_what_one_extra_installs_another_does_not_install_again(tmp_path):
    result = in_workspace(
        tmp_path,
        """
        pip() { :; }
        options_of_missing() { :; }
        is_venv_whole() { [[ -e $root/.venv/.set-up ]]; }
        mkdir -p .venv; touch .venv/.set-up
        install() {
            requirement_files=(requirements.txt "$@")
            requirements=$(cd scripts && missing_requirements "${requirement_files[@]}")
            make_venv
            install_requirements
        }
        install requirements-docs.txt
        install requirements-cockpit.txt
        cd scripts
        missing_requirements requirements.txt requirements-docs.txt requirements-cockpit.txt
        echo >>requirements-docs.txt
        missing_requirements requirements.txt requirements-docs.txt requirements-cockpit.txt
        """,
    )
    assert result.stdout.split() == ["requirements-docs.txt"], result.stderr
    stamps = (tmp_path / ".venv/.set-up").read_text().splitlines()
    assert len(stamps) == 3 and not (tmp_path / ".venv/.set-up.before").exists()


BESIDE = """
    missing_requirements() { echo requirements.txt; }
    missing_packages() { :; }
    announce() { :; }
    prepare_python() { :; }
    fetch_requirements() { until [[ -e building ]]; do sleep 0.01; done; }
    install_requirements() { touch installed; }
    warm_kernels() { touch compiled; }
    shield_rospy() { :; }
    catkin_build() { mkdir -p $1/devel; touch building; }
"""


def test_python_packages_and_kernels_are_made_beside_the_build(tmp_path):
    result = in_workspace(
        tmp_path, BESIDE + "mkdir src; set_up; ls installed compiled devel/.set-up build/.kernels"
    )
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize(
    "step, code, sentence",
    [
        ("fetch_requirements", 1, "error: the Python packages could not be fetched"),
        ("install_requirements", 1, "error: pip failed"),
        ("warm_kernels", 0, "warning: the kernels were not compiled"),
    ],
)
def test_a_failure_beside_the_build_is_reported_after_it(tmp_path, step, code, sentence):
    result = in_workspace(tmp_path, BESIDE + f"mkdir src; {step}() {{ false; }}; set_up")
    assert result.returncode == code
    assert sentence in result.stdout + result.stderr
    assert (tmp_path / "devel/.set-up").exists()


def test_a_long_build_shows_its_time_and_how_much_is_built(tmp_path):
    result = in_workspace(
        tmp_path,
        """
        sleep() { command sleep 0.01; }  # of the clock
        build() {
            printf -- '-- ~~  traversing 85 packages in order:\n-- +++ processing catkin package: amcl\n'
            command sleep 2; echo "[ 14%] Building"; command sleep 2; echo "[100%] Built"; command sleep 2
        }
        step Building logs/setup/build.log build
        step Waiting logs/setup/waiting.log command sleep 2
        """,
    )
    building, waiting = result.stdout.split("Waiting ...")
    assert re.match(r"Building \.\.\.\n  \.\.\. \d+ s, 1 of 85 packages configured\n", building)
    assert re.search(r"  \.\.\. \d+ s, 14 %\n", building)
    assert re.search(r"  \.\.\. \d+ s, 100 %\n", building)
    assert re.search(r"  \.\.\. \d+ s\n", waiting)


def test_the_build_does_not_see_what_pip_has_installed_by_half(tmp_path):
    subprocess.check_call(["/usr/bin/python3", "-m", "venv", "--without-pip", tmp_path / ".venv"])
    (site,) = (tmp_path / ".venv/lib").glob("python3.*/site-packages")
    (site / "catkin_pkg").mkdir()
    (site / "catkin_pkg/__init__.py").write_text("from .not_there_yet import name\n")
    generating = """
        mkdir src
        sed -i s/false/true/ .venv/pyvenv.cfg
        catkin_make() { .venv/bin/python3 -c 'import catkin_pkg; print(catkin_pkg.__file__)'; }
        catkin_build build/1
    """
    result = in_workspace(tmp_path, generating)
    assert result.returncode == 0, result.stderr


def test_the_reason_is_reported_although_other_packages_are_built_after_it(tmp_path):
    beside = """
        catkin_build() {
            echo 'ImportError: the reason'
            echo 'make[2]: *** [mine/CMakeFiles/mine_py.dir/build.make:93: mine/_A.py] Error 1'
            seq --format='[ %g%%] Built target other' 30
            return 1
        }
        mkdir src; retry=''; look_for_missing; build_workspace
    """
    result = in_workspace(tmp_path, beside).stderr
    assert "| ImportError: the reason\n" in result and "the package 'mine' does not build" in result


def test_a_full_disk_is_reported_even_without_a_log(tmp_path):
    no_room = "df() { printf 'Avail\\n7\\n'; }; : >log; give_up 'pip failed' log"
    assert in_workspace(tmp_path, no_room).stderr.startswith("error: the disk is full")


def test_a_build_for_which_there_was_no_room_is_tried_again(tmp_path):
    set_up_once(tmp_path)
    write_package(tmp_path / "src/mine", "mine")
    full = FAILING + "catkin_build() { echo 'as: No space left on device'; return 1; }; "
    for _ in range(2):
        result = in_workspace(tmp_path, full + "set_up; echo used")
        assert result.returncode == 0, result.stderr
        assert "Building" in result.stdout and result.stdout.endswith("used\n")
        assert result.stderr.splitlines() == [
            "warning: the disk is full: make room and start again, it goes on from there: "
            "the workspace is used as it was built before"
        ]
    assert (tmp_path / "devel/setup.bash").read_text() == "good\n"


def test_without_network_the_package_lists_are_not_to_blame(tmp_path):
    offline = (
        "apt_get() { printf 'Temporary failure resolving\\nE: Unable to locate package\\n'; return 1; }; "
    )
    result = in_workspace(tmp_path, offline + "install_packages catkin")
    assert result.stderr.startswith("error: no network: the packages could not be downloaded")


DPKG = """
    mkdir bin; PATH=$PWD/bin:$PATH; sudo=()
    printf '#!/bin/sh\\n%s\\n' "$APT" >bin/apt-get
    printf '#!/bin/sh\\n%s\\n' "$DPKG" >bin/dpkg
    chmod +x bin/*
    apt_get catkin
"""


@pytest.mark.parametrize(
    ("apt", "dpkg"),
    [
        pytest.param("exit 0", "echo frontend lock was locked; exit 2", id="another installation at work"),
        pytest.param("[ -e finished ] || exit 100", "touch finished", id="an interrupted installation"),
    ],
)
def test_other_installations_are_waited_for_or_finished(tmp_path, monkeypatch, apt, dpkg):
    monkeypatch.setenv("APT", apt)
    monkeypatch.setenv("DPKG", dpkg)
    result = in_workspace(tmp_path, DPKG)
    assert result.returncode == 0, result.stdout + result.stderr


def test_a_proxy_that_is_down_is_reported_without_its_password(tmp_path, monkeypatch):
    monkeypatch.setenv("https_proxy", "http://me:secret@127.0.0.1:9")
    result = in_workspace(
        tmp_path, "echo 'ProxyError(Cannot connect to proxy.)' >log; give_up 'pip failed' log"
    )
    assert result.stderr.startswith("error: the proxy 127.0.0.1:9 does not answer")


@pytest.mark.parametrize(
    ("machine", "sentence"),
    [
        (("debian", "13", ""), ""),
        (("debian", "11", ""), ""),
        (("ubuntu", "22.04", ""), ""),
        (("ubuntu", "24.04", ""), "error: this is ubuntu: the workspace needs Debian 11, 12 or 13"),
        (("debian", "12", "uname() { echo aarch64; }"), ""),
        (("debian", "12", "uname() { echo armv7l; }"), "error: this machine is armv7l: "),
        (("debian", "12", "getconf() { echo glibc 2.12; }"), "error: the C library is glibc 2.12: "),
        (("debian", "12", "getconf() { false; }"), "error: the C library is not glibc: "),
    ],
)
def test_a_machine_that_cannot_serve_is_refused_in_a_sentence(tmp_path, machine, sentence):
    system, version, command = machine
    (tmp_path / "os-release").write_text(f"ID={system}\nVERSION_ID={version}\n")
    result = in_workspace(tmp_path, f"{command}\nos_release=os-release; check_system")
    assert result.returncode == (1 if sentence else 0)
    assert result.stderr.startswith(sentence) and result.stderr.count("\n") == bool(sentence)


def test_a_read_only_tree_is_reported(tmp_path):
    result = in_workspace(tmp_path, "may_write() { false; }; check_place")
    assert (
        result.stderr
        == f"error: '{tmp_path}' is read-only, and the workspace in it is not set up: make it writable\n"
    )


def test_a_second_set_up_waits_for_the_first_and_reports_it(tmp_path):
    in_workspace(tmp_path, ":")
    with (tmp_path / "scripts/setup.sh").open() as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        waiting = [
            "timeout",
            "1",
            "bash",
            "-c",
            '. "$1"; take_turns',
            "bash",
            str(tmp_path / "scripts/setup.sh"),
        ]
        result = subprocess.run(waiting, capture_output=True, text=True)
    assert result.stdout.startswith("Waiting for another set-up of this workspace ...")
    assert in_workspace(tmp_path, "take_turns").stdout == ""


def test_a_corrupt_wheel_is_built_again(tmp_path):
    name = "pybullet-1-cp313-cp313-linux_x86_64.whl"
    with zipfile.ZipFile(tmp_path / name, "w") as whole:
        whole.writestr("pybullet.so", b"0" * 1000)
    (tmp_path / f"half-{name}").write_bytes((tmp_path / name).read_bytes()[:500])
    check = "{ has_whole_wheel $each && echo whole || echo broken; }"
    result = in_workspace(tmp_path, f"for each in {name} half-{name} none; do {check}; done")
    assert result.stdout.split() == ["whole", "broken", "broken"]


def test_rospy_of_debian_11_finds_the_method_that_its_python_has_dropped(tmp_path):
    site = tmp_path / ".venv/lib/python3.9/site-packages"
    site.mkdir(parents=True)
    for code, shields in (("t.is_alive()", 0), ("t.isAlive()", 1)):
        (tmp_path / "core.py").write_text(code)
        result = in_workspace(tmp_path, "rospy_of_system=$PWD; shield_rospy")
        assert result.returncode == 0, result.stderr
        assert len(list(site.iterdir())) == shields
    calls = "import sys, site, threading; site.addsitedir(sys.argv[1]); threading.Thread().isAlive()"
    subprocess.run([sys.executable, "-c", calls, str(site)], check=True)


def test_a_half_built_wheel_never_reaches_the_cache(tmp_path):
    result = in_workspace(
        tmp_path,
        f'wheels={tmp_path}/cache; pip_of() {{ touch "$work/pybullet-half.whl"; return 1; }}; build_wheel',
    )
    assert result.returncode == 1
    assert list((tmp_path / "cache").iterdir()) == []


KERNEL = """
from numba import njit


@njit(cache=True)
def doubled(number):
    return 2 * number


doubled(21)
COMPILED = sum(doubled.stats.cache_misses.values())
"""


def kernels_compiled(folder, set_up=":"):
    """How many kernels a program compiles whose user has the folder's home, and where it keeps them."""
    program = "import sys; sys.path.insert(0, 'src/good'); import kernel; print(kernel.COMPILED)"
    commands = f'{set_up}; "{sys.executable}" -c "{program}"; echo ${{NUMBA_CACHE_DIR:-beside}}'
    result = in_workspace(folder, f"export HOME=$PWD/home; {commands}")
    assert result.returncode == 0, result.stderr
    compiled, place = result.stdout.splitlines()
    return int(compiled), place


def test_a_user_who_may_not_write_beside_the_kernels_has_current_copies_of_them(tmp_path, monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    module = tmp_path / "src/good/kernel.py"
    stamp = tmp_path / "build/.kernels"
    module.parent.mkdir(parents=True)
    stamp.parent.mkdir()
    for revision in range(2):
        module.write_text(KERNEL + "#" * revision)
        assert kernels_compiled(tmp_path) == (1, "beside")
        stamp.write_text(str(revision))
        for _ in range(2):
            compiled, place = kernels_compiled(tmp_path, "may_write() { false; }; use_own_kernels $PWD")
            assert compiled == 0
            assert tmp_path / "home/.cache" in Path(place).parents
    assert kernels_compiled(tmp_path, "use_own_kernels $PWD") == (0, "beside")


@pytest.mark.parametrize(
    "end, left", [pytest.param("command cp", 1, id="to the end"), pytest.param("exit 0;", 2, id="by half")]
)
def test_two_scripts_copy_the_kernels_at_one_time(tmp_path, monkeypatch, end, left):
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    for package in ("first", "second"):
        compiled = tmp_path / "src" / package / "__pycache__"
        compiled.mkdir(parents=True)
        (compiled / "kernel.nbi").touch()
    (tmp_path / "build").mkdir()
    (tmp_path / "build/.kernels").write_text("1")
    other = f'. "$1"; may_write() {{ false; }}; cp() {{ {end} "$@"; }}; use_own_kernels "$root"'
    result = in_workspace(
        tmp_path,
        f"""
        may_write() {{ false; }}
        cp() {{
            [[ $1 != */src/second/* ]] || bash -c '{other}' bash "$root/scripts/setup.sh"
            command cp "$@"
        }}
        use_own_kernels "$root"
        ls -A "$NUMBA_CACHE_DIR" "$NUMBA_CACHE_DIR"/second_*
        """,
    )
    assert result.returncode == 0, result.stderr
    assert {".kernels", "kernel.nbi"} < set(result.stdout.split())
    assert len(list((tmp_path / "cache/home-service-robot/kernels").iterdir())) == left


def test_a_user_who_has_no_home_has_a_cache_too(tmp_path, monkeypatch):
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    result = in_workspace(tmp_path, "export HOME=/dev/null TMPDIR=$PWD; user_cache")
    assert result.stdout == f"{tmp_path}/home-service-robot-{os.getuid()}\n"


def test_a_user_who_may_not_write_in_the_workspace_has_a_folder_for_ros(tmp_path, monkeypatch):
    for variable in ("XDG_CACHE_HOME", "ROS_HOME", "ROS_LOG_DIR"):
        monkeypatch.delenv(variable, raising=False)
    (tmp_path / "devel").mkdir()
    (tmp_path / "devel/setup.bash").touch()
    for may_write, place in (("true", "logs"), ("false", "home/.cache/home-service-robot")):
        commands = "export HOME=$PWD/home; enter_workspace; echo $ROS_HOME"
        result = in_workspace(tmp_path, f"may_write() {{ {may_write}; }}; {commands}")
        assert result.stdout == f"{tmp_path}/{place}/ros\n"
