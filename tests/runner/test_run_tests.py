import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest
from outcome import Outcome, judge_ros_test, judge_unit_tests, read_report
from ros_test import time_limits
from rostest_plugin import NEEDS, ROOT, is_installed, missing_requirement


def write_report(path, tests, failures=0, errors=0, skipped=0):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(
        f'<testsuite tests="{tests}" failures="{failures}" errors="{errors}" skipped="{skipped}"></testsuite>'
    )
    return path


def test_a_report_is_counted_over_all_its_suites(tmp_path):
    path = tmp_path / "unit.xml"
    path.write_text(
        '<testsuites><testsuite tests="5" failures="1" errors="1" skipped="1"/>'
        '<testsuite tests="2"/></testsuites>'
    )
    assert read_report(path) == Outcome(passed=4, failed=2, skipped=1)


@pytest.mark.parametrize(
    "kind, reason",
    [
        ('<failure message="assert 1 == 2">...</failure>', "test_b: assert 1 == 2"),
        (
            "<error>3 m too far\n  File x, line 3\n    drive()\n    ^^^^^^^\n</error>",
            "test_b: 3 m too far",
        ),
    ],
)
def test_the_reason_is_the_message_of_the_failure(tmp_path, kind, reason):
    path = tmp_path / "unit.xml"
    cases = f'<testcase name="test_a"/><testcase name="test_b">{kind}</testcase>'
    path.write_text(f'<testsuite tests="2" failures="1">{cases}</testsuite>')
    assert read_report(path) == Outcome(passed=1, failed=1, reasons=(reason,))


def test_every_failure_is_named(tmp_path):
    path = tmp_path / "unit.xml"
    cases = "".join(f'<testcase name="{name}"><failure message="no"/></testcase>' for name in "ab")
    path.write_text(f'<testsuite tests="2" failures="2">{cases}</testsuite>')
    outcome = read_report(path) + Outcome(failed=1, reasons=("c: no",))
    assert outcome.reasons == ("a: no", "b: no", "c: no")


def test_what_fails_before_the_first_test_takes_nothing_from_those_that_passed(tmp_path):
    report = read_report(write_report(tmp_path / "unit.xml", 0, errors=1))
    assert (report.passed, report.failed) == (0, 1)


def test_a_ros_test_without_a_report_has_failed_although_rostest_ended_with_zero(tmp_path):
    write_report(tmp_path / "tests" / "rostest-a.xml", 1)
    outcome = judge_ros_test(["a"], tmp_path, 0)
    assert (outcome.passed, outcome.failed) == (0, 1)
    assert "'a' left no report" in outcome.reason


def test_a_report_of_no_tests_is_a_failure(tmp_path):
    write_report(tmp_path / "rosunit-a.xml", 0)
    assert judge_ros_test(["a"], tmp_path, 0).failed == 1


def test_a_file_that_names_no_test_is_a_failure(tmp_path):
    assert judge_ros_test([], tmp_path, 0).failed == 1


def test_the_time_limits_a_file_are_summed(tmp_path):
    write_report(tmp_path / "p" / "rosunit-a.xml", 3)
    write_report(tmp_path / "p" / "rosunit-b.xml", 2, failures=1)
    write_report(tmp_path / "p" / "rostest-ab.xml", 2)
    assert judge_ros_test(["a", "b"], tmp_path, 1) == Outcome(passed=4, failed=1)


def test_a_failure_of_rostest_counts_when_every_report_is_clean(tmp_path):
    write_report(tmp_path / "rosunit-a.xml", 3)
    write_report(tmp_path / "rostest-a.xml", 1, errors=1)
    assert judge_ros_test(["a"], tmp_path, 0).failed == 1


@pytest.mark.parametrize("exit_code, failed", [(0, 0), (3, 1)])
def test_an_exit_code_counts_when_every_report_is_clean(tmp_path, exit_code, failed):
    write_report(tmp_path / "rosunit-a.xml", 3)
    assert judge_ros_test(["a"], tmp_path, exit_code).failed == failed
    assert judge_unit_tests(write_report(tmp_path / "unit.xml", 3), exit_code).failed == failed


def test_a_garbled_report_is_a_failure(tmp_path):
    (tmp_path / "unit.xml").write_text("<testsuite")
    assert judge_unit_tests(tmp_path / "unit.xml", 0).failed == 1


def test_a_pytest_run_without_tests_is_a_failure_that_names_what_is_missing(tmp_path):
    outcome = judge_unit_tests(write_report(tmp_path / "unit.xml", 0), 5)
    assert outcome.failed == 1 and "setup.sh --dev" in outcome.reason


def test_the_time_limits_of_a_file_are_read(tmp_path):
    path = tmp_path / "x.test"
    path.write_text(
        '<launch><test test-name="a" pkg="p" type="t" time-limit="90"/><group>'
        '<test test-name="b" pkg="p" type="t"/></group></launch>'
    )
    assert time_limits(path) == {"a": 90.0, "b": 60.0}


def test_what_needs_something_that_is_not_there_is_left_out():
    two_hosts, mission = ROOT / "tests/two_hosts/two_hosts.test", ROOT / "tests/system/m.test"
    assert missing_requirement(two_hosts, lambda name: False) == "ip"
    assert missing_requirement(two_hosts, lambda name: True) is None
    assert missing_requirement(mission, lambda name: False) is None


def test_a_browser_alone_shows_no_page():
    page = ROOT / "tests/cockpit/course.test"
    assert missing_requirement(page, lambda name: name == "google-chrome") == "viser"
    assert missing_requirement(page, lambda name: name in ("google-chrome", "viser")) is None


def test_a_test_may_need_more_than_its_folder_does():
    alone = ROOT / "tests" / "two_hosts" / "cockpit_alone.test"
    assert missing_requirement(alone, lambda name: name == "ip") == "chromium"
    assert missing_requirement(alone, lambda name: name == "google-chrome") == "ip"
    assert missing_requirement(alone, lambda name: name in ("ip", "google-chrome", "viser")) is None


def test_what_needs_something_is_there():
    assert all((ROOT / place).exists() for place in NEEDS)


# Stands in for rostest: writes the report of a test, leaves without one, or runs until it is interrupted.
ROSTEST = """#!/usr/bin/env python3
import pathlib, sys, time
folder, path = pathlib.Path(sys.argv[1].partition("=")[2]), pathlib.Path(sys.argv[2])
folder.mkdir(exist_ok=True)
print("the log of", path.stem)
if path.stem == "endless":
    folder.joinpath("started").touch()
    time.sleep(1000)
failures = int(path.stem == "broken")
if path.stem != "lost":
    case = '<testcase name="test_x"><failure message="1 is not 2"/></testcase>' * failures
    (folder / "rosunit-t.xml").write_text(f'<testsuite tests="3" failures="{failures}">{case}</testsuite>')
"""
TEST_FILE = '<launch><test test-name="t" pkg="p" type="t"/></launch>'


@pytest.fixture
def ros_tests(tmp_path, request):
    """Returns the command to run .test files with a stand-in for rostest, and its environment."""
    programs = tmp_path / "programs"
    programs.mkdir()
    (programs / "rostest").write_text(ROSTEST)
    (programs / "rostest").chmod(0o755)
    place = ROOT / "build" / f"test_files_{os.getpid()}_{tmp_path.name}"
    place.mkdir(parents=True)
    request.addfinalizer(lambda: shutil.rmtree(place))

    def ros_tests(*names, jobs, needs="", quick=False):
        for name in names:
            (place / f"{name}.test").write_text(TEST_FILE)
        script = (
            "import sys, rostest_plugin; from pathlib import Path; from run_tests import run_ros_tests;"
            "logs, jobs, quick, needs, *paths = sys.argv[1:];"
            "place = str(Path(paths[0]).parent.relative_to(rostest_plugin.ROOT));"
            "rostest_plugin.NEEDS[place] = ((needs,),) if needs else ();"
            "print(run_ros_tests(Path(logs), [*map(Path, paths)], int(jobs), bool(quick)))"
        )
        paths = [place / f"{name}.test" for name in names]
        command = [sys.executable, "-c", script, tmp_path, str(jobs), "yes" if quick else "", needs, *paths]
        environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}
        return {"args": command, "env": environment, "cwd": Path(__file__).parent}

    return ros_tests


@pytest.mark.parametrize("jobs", [1, 2])
def test_pytest_runs_test_files_and_counts_their_tests(ros_tests, jobs):
    command = ros_tests("good", "broken", "lost", jobs=jobs)
    run = subprocess.run(**command, capture_output=True, text=True, timeout=120.0)
    lines = run.stdout.splitlines()
    assert lines[-1] == "5 passed, 2 failed", run.stdout + run.stderr
    assert any("test_x: 1 is not 2 -- " in line for line in lines)
    assert any("test 't' left no report -- " in line for line in lines)
    assert "  | the log of broken" in lines and "  | the log of good" not in lines


@pytest.mark.parametrize("quick", [False, True])
def test_only_a_quick_run_leaves_out_what_needs_something_that_is_not_there(ros_tests, quick):
    command = ros_tests("good", jobs=1, needs="no_such_command", quick=quick)
    run = subprocess.run(**command, capture_output=True, text=True, timeout=120.0)
    assert run.stdout.splitlines()[-1] == ("0 passed, 0 failed" if quick else "0 passed, 1 failed")
    assert "needs no_such_command; run ./scripts/setup.sh --dev" in run.stdout


@pytest.mark.parametrize("jobs", [1, 2])
def test_an_interrupted_run_leaves_no_process(ros_tests, tmp_path, jobs):
    command = ros_tests("endless", "good", jobs=jobs)
    process = subprocess.Popen(**command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    deadline = time.monotonic() + 60.0
    while not [*tmp_path.glob("*/started")] and time.monotonic() < deadline:
        time.sleep(0.05)
    left = psutil.Process(process.pid).children(recursive=True)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60.0)
    assert process.returncode != 0
    assert left and not any(child.is_running() for child in left)


def chosen(names, missing):
    """Return the unit test files that pytest collects when a package is missing."""
    script = (
        "import importlib.util as util, sys, pytest; there = util.find_spec; missing, *names = sys.argv[1:];"
        "util.find_spec = lambda name, *given: None if name == missing else there(name, *given);"
        "pytest.main(['--collect-only', '-p', 'no:xdist', *names])"
    )
    command = [sys.executable, "-c", script, missing, *(f"--only={name}" for name in names)]
    listing = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, timeout=120)
    return {
        line.partition("::")[0].rpartition("/")[2] for line in listing.stdout.splitlines() if "::" in line
    }


def test_unit_tests_that_are_named_are_left_out_where_what_they_need_is_missing():
    names = ("laboratory/test/test_search", "runner/test_run")
    assert chosen(names, missing="optuna") == {"test_run_tests.py"}


def test_commands_and_packages_are_found():
    assert is_installed("bash") and is_installed("numpy") and not is_installed("no_such_command")


def contained(command, log, limit=60.0):
    """Return the failure reason of a command that a child process contains."""
    script = (
        "import sys; from pathlib import Path; from containment import run_contained;"
        "from outcome import Outcome;"
        "log, limit, *command = sys.argv[1:];"
        "print(run_contained(command, Path(log), float(limit), lambda code: Outcome(passed=1)).reason)"
    )
    output = subprocess.run(
        [sys.executable, "-c", script, str(log), str(limit), *command],
        cwd=Path(__file__).parent,
        stdout=subprocess.PIPE,
        text=True,
        timeout=60.0,
        check=True,
    )
    return output.stdout.strip()


def test_a_command_that_leaves_nothing_behind_is_judged_by_its_exit_code(tmp_path):
    assert contained(["true"], tmp_path / "x.log") == ""


def test_what_is_ending_when_its_command_exits_is_not_left_behind(tmp_path):
    assert contained(["sh", "-c", "(sleep 0.5; sleep 0.5) &"], tmp_path / "x.log") == ""


def test_a_process_that_outlives_its_command_is_ended_and_reported(tmp_path):
    number = tmp_path / "number"
    named = "until grep -q sleep /proc/$!/comm; do :; done"  # until then it is a copy of the shell
    left = f"sleep 1000 & echo $! > {number}; {named}"
    assert contained(["sh", "-c", left], tmp_path / "x.log") == "left processes behind: sleep"
    assert not Path("/proc", number.read_text().strip()).exists()


def test_a_command_that_does_not_end_is_ended_at_its_limit(tmp_path):
    assert contained(["sleep", "1000"], tmp_path / "x.log", 0.5) == "not done after its limit of 0 s"


def test_what_is_started_while_all_is_ended_is_ended_too(tmp_path):
    number = tmp_path / "number"
    stubborn = f"trap 'sleep 1000 & echo $! > {number}; exit' INT; sleep 1000 & wait"
    assert contained(["sh", "-c", stubborn], tmp_path / "x.log", 1.0) == "not done after its limit of 1 s"
    assert not Path("/proc", number.read_text().strip()).exists()
