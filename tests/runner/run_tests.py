"""Runs the unit tests and the ROS tests and tells the truth about them in one closing line.

The exit codes of ``rostest`` and ``catkin_make run_tests`` do not tell whether every test ran, so the verdict
comes from the reports: a test file without a report of its tests has failed.
"""

import argparse
import ctypes
import os
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import dataclass, replace
from datetime import datetime
from pathlib import Path
from typing import Dict, List, Optional, Sequence
from xml.etree import ElementTree

import psutil

ROOT = Path(__file__).resolve().parents[2]
PYTEST = ("-m", "pytest", "-n", "auto", "--dist", "worksteal")
UNIT_SECONDS = 900.0  # of a machine that has other things to do; else a minute
ROSTEST_DEFAULT_SECONDS = 60.0  # of a <test> without time-limit
START_AND_STOP_SECONDS = 60.0  # of everything around the <test>s of a file
GRACE_SECONDS = 15.0
PR_SET_CHILD_SUBREAPER = 36
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
# Commands that scripts/setup.sh --dev installs, by the test, or folder of tests, that needs one of them.
NEEDS = {
    "tests/cockpit": BROWSERS,
    "tests/two_hosts": ("ip",),
    "tests/two_hosts/cockpit_alone.test": BROWSERS,
}


@dataclass(frozen=True)
class Outcome:
    """How many tests of a file passed, failed, were skipped; ``reason`` if it did not run as it should."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0
    reason: str = ""

    def __add__(self, other: "Outcome") -> "Outcome":
        return Outcome(
            self.passed + other.passed,
            self.failed + other.failed,
            self.skipped + other.skipped,
            self.reason or other.reason,
        )

    def __str__(self) -> str:
        skipped = f", {self.skipped} skipped" if self.skipped else ""
        return f"{self.passed} passed, {self.failed} failed{skipped}"


def failure(reason: str) -> Outcome:
    return Outcome(failed=1, reason=reason)


def read_report(path: Path) -> Outcome:
    """The counts of a JUnit report, over all its suites, and what the first failure says."""
    try:
        report = ElementTree.parse(path).getroot()
        suites = list(report.iter("testsuite"))
        counts = {
            name: sum(int(suite.get(name, 0)) for suite in suites)
            for name in ("tests", "failures", "errors", "skipped")
        }
    except (OSError, ElementTree.ParseError, ValueError) as error:
        return failure(f"no readable report {path.name}: {error}")
    failed = counts["failures"] + counts["errors"]
    return Outcome(
        max(counts["tests"] - failed - counts["skipped"], 0),
        failed,
        counts["skipped"],
        first_failure(report),
    )


def first_failure(report: ElementTree.Element) -> str:
    """The name and the message of the first test that failed; empty if none did."""
    for case in report.iter("testcase"):
        for kind in ("failure", "error"):
            found = case.find(kind)
            if found is not None:
                # pytest's is an attribute; rosunit's stands before the traceback.
                message = found.get("message") or (found.text or "").strip().partition("\n")[0]
                return f"{case.get('name')}: {' '.join(message.split())[:300]}"
    return ""


def judge_unit_tests(report: Path, exit_code: int) -> Outcome:
    outcome = read_report(report)
    if exit_code != 0 and not outcome.failed:
        return outcome + failure(f"pytest ended with exit code {exit_code}")
    return outcome


def judge_ros_test(test_names: Sequence[str], reports: Path, exit_code: int) -> Outcome:
    """Sums the reports of the tests named in one .test file; each must have reported at least one test."""
    total = Outcome()
    for name in test_names:
        found = sorted(reports.rglob(f"rosunit-{name}.xml"))
        outcome = read_report(found[0]) if found else failure(f"test '{name}' left no report")
        if outcome == Outcome():
            outcome = failure(f"test '{name}' ran no test")
        total += outcome
    if not test_names:
        total = failure("it names no test")
    for path in sorted(reports.rglob("rostest-*.xml")):
        if read_report(path).failed and not total.failed:
            total += failure("rostest reports a test that did not end well")
    if exit_code != 0 and not total.failed:
        total += failure(f"rostest ended with exit code {exit_code}")
    return total


def lacking(path: Path, find=shutil.which) -> Optional[str]:
    """The command that the tests of a .test file need and this machine has not."""
    place = path.relative_to(ROOT)
    for names in (NEEDS.get(each.as_posix(), ()) for each in (place.parent, place)):
        if names and not any(map(find, names)):
            return names[0]
    return None


def time_limits(path: Path) -> Dict[str, float]:
    """The time limit, in seconds, of each test that a .test file names."""
    tests = ElementTree.parse(path).getroot().iter("test")
    return {
        test.attrib["test-name"]: float(test.get("time-limit", ROSTEST_DEFAULT_SECONDS)) for test in tests
    }


class Runner:
    """Runs test files one after the other, each with its own log and reports below ``folder``."""

    def __init__(self, folder: Path):
        self._folder = folder
        self._total = Outcome()
        self._complaints: List[str] = []
        # Whatever outlives its parent becomes a child of this process, so that nothing escapes the sweep.
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)

    def run_unit_tests(self, files: Sequence[Path]) -> None:
        report = self._folder / "unit.xml"
        command = [sys.executable, *PYTEST, f"--junitxml={report}", *map(str, files)]
        self._run("unit", command, UNIT_SECONDS, lambda code: judge_unit_tests(report, code))

    def run_ros_test(self, path: Path) -> None:
        limits = time_limits(path)
        name = path.relative_to(ROOT).with_suffix("").as_posix()
        reports = self._folder / name.replace("/", ".")
        command = ["rostest", f"--results-base-dir={reports}", str(path)]
        limit = sum(limits.values()) + START_AND_STOP_SECONDS
        self._run(name, command, limit, lambda code: judge_ros_test(list(limits), reports, code))

    def conclude(self) -> int:
        for complaint in self._complaints:
            print(complaint)
        print(self._total)
        return 0 if self._total.passed and not self._total.failed else 1

    def _run(self, name, command, limit, judge) -> None:
        log = self._folder / f"{name.replace('/', '.')}.log"
        environment = {**os.environ, "ROS_HOME": str(log.with_suffix("")), "PYTHONUNBUFFERED": "1"}
        environment["ROS_LOG_DIR"] = environment["ROS_HOME"]
        print(f"{name} ...", flush=True)
        started = time.monotonic()
        try:
            with log.open("w") as output:
                process = subprocess.Popen(
                    command,
                    cwd=ROOT,
                    env=environment,
                    stdin=subprocess.DEVNULL,
                    stdout=output,
                    stderr=subprocess.STDOUT,
                    start_new_session=True,
                )
                try:
                    outcome = judge(process.wait(limit))
                except subprocess.TimeoutExpired:
                    outcome = failure(f"not done after its limit of {limit:.0f} s")
        finally:
            left = sweep()
        if left and not outcome.failed:
            outcome += failure(f"left processes behind: {', '.join(left)}")
        print(f"  {outcome} ({time.monotonic() - started:.0f} s)", flush=True)
        self._total += replace(outcome, reason="")
        if outcome.failed:
            self._complaints.append(f"FAILED {name}: {outcome.reason or 'see the log'} -- {log}")
            print(indented_tail(log), flush=True)


def sweep() -> List[str]:
    """Ends every process below this one, gently at first; returns the names of those that were there."""
    children = psutil.Process().children(recursive=True)
    _, alive = psutil.wait_procs(children, timeout=0.0)
    names = [_name(process) for process in alive]
    for number in (signal.SIGINT, signal.SIGKILL):
        for process in alive:
            try:
                process.send_signal(number)
            except psutil.NoSuchProcess:
                continue
        _, alive = psutil.wait_procs(alive, timeout=GRACE_SECONDS)
    return names


def _name(process: psutil.Process) -> str:
    try:
        return process.name()
    except psutil.NoSuchProcess:
        return "one that just ended"


def indented_tail(path: Path, lines: int = 60) -> str:
    return "\n".join("  | " + line for line in path.read_text(errors="replace").splitlines()[-lines:])


def matching(paths, names: Sequence[str]) -> List[Path]:
    relative = {path: path.relative_to(ROOT).as_posix() for path in paths}
    return sorted(path for path, text in relative.items() if not names or any(name in text for name in names))


def main() -> int:
    parser = argparse.ArgumentParser(prog="test.sh", description="Runs the tests.")
    parser.add_argument("kind", nargs="?", choices=("unit", "ros", "all"), default="all")
    parser.add_argument("names", nargs="*", metavar="NAME", help="only test files whose paths contain it")
    options = parser.parse_args()

    unit_paths = [
        *ROOT.glob("src/**/test/test_*.py"),
        *ROOT.glob("tests/runner/test_*.py"),
        *ROOT.glob("tests/repository/test_*.py"),
        *ROOT.glob("tests/fuzz/test_*.py"),
    ]
    unit = matching(unit_paths, options.names) if options.kind in ("unit", "all") else []
    ros = matching(ROOT.glob("tests/**/*.test"), options.names) if options.kind in ("ros", "all") else []
    if not unit and not ros:
        parser.error(f"no test file matches {' '.join(options.names)}")

    folder = ROOT / "logs" / "tests" / f"{datetime.now():%Y%m%d-%H%M%S}-{os.getpid()}"
    folder.mkdir(parents=True)
    runner = Runner(folder)
    if unit:
        # A file that is named is collected even where its folder's conftest.py leaves it out.
        runner.run_unit_tests(unit if options.names else [])
    for path in ros:
        command = lacking(path)
        if command is None:
            runner.run_ros_test(path)
        else:
            print(f"left out: {path.relative_to(ROOT)}, which needs {command} (./scripts/setup.sh --dev)")
    return runner.conclude()


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        sys.exit(130)
