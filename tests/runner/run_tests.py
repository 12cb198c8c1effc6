"""Run the unit tests and the ROS tests and print one summary line.

The exit codes of ``rostest`` and ``catkin_make run_tests`` do not show whether every test ran, so the result
comes from the reports: a test file without a report of its tests has failed.
"""

import argparse
import os
import shutil
import signal
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import replace
from datetime import datetime
from importlib.util import find_spec
from pathlib import Path
from typing import List, Optional, Sequence

from containment import ROOT, run_contained
from outcome import Outcome, failure, judge_unit_tests
from ros_test import RosTest, log_of

from supervision.command_line import count
from supervision.interruption import on_signals

PYTEST = ("-m", "pytest", "-n", "auto", "--dist", "worksteal")
UNIT_SECONDS = 900.0  # on a busy machine; usually a minute
MOST_JOBS = 4
# Requirements that scripts/setup.sh --dev installs, by test file or folder: one command or
# package of each group.
BROWSERS, PAGE = ("chromium", "chromium-browser", "google-chrome"), ("viser",)
NEEDS = {
    "tests/cockpit": (BROWSERS, PAGE),
    "tests/two_hosts": (("ip",),),
    "tests/two_hosts/cockpit_alone.test": (BROWSERS, PAGE),
    "tests/two_hosts/laboratory_two_hosts.test": (("distributed",),),
}


def is_installed(name: str) -> bool:
    return shutil.which(name) is not None or find_spec(name) is not None


def missing_requirement(path: Path, is_there=is_installed) -> Optional[str]:
    """Return a requirement of a .test file that is not installed, or None."""
    place = path.relative_to(ROOT)
    for group in (*NEEDS.get(place.parent.as_posix(), ()), *NEEDS.get(place.as_posix(), ())):
        if not any(map(is_there, group)):
            return group[0]
    return None


def run_unit_tests(folder: Path, names: Sequence[str]) -> Outcome:
    report = folder / "unit.xml"
    command = [sys.executable, *PYTEST, f"--junitxml={report}", *(f"--only={name}" for name in names)]
    return run_contained(
        command, log_of(folder, "unit"), UNIT_SECONDS, lambda code: judge_unit_tests(report, code)
    )


class RunSummary:
    """Prints the outcome of each test file and a summary. Logs and reports are in ``folder``."""

    def __init__(self, folder: Path):
        self._folder = folder
        self._total = Outcome()
        self._failures: List[str] = []

    def add(self, name: str, outcome: Outcome, seconds: float) -> None:
        print(f"{name}: {outcome} ({seconds:.0f} s)", flush=True)
        self._total += replace(outcome, reason="")
        if outcome.failed:
            log = log_of(self._folder, name)
            self._failures.append(f"FAILED {name}: {outcome.reason or 'see the log'} -- {log}")
            if log.exists():  # a terminated test may have no log
                print(indented_tail(log), flush=True)

    def add_missing(self, name: str, need: str, is_skipped: bool) -> None:
        """Skip a test file whose requirement is not installed, or count it as failed."""
        reason = f"needs {need}; run ./scripts/setup.sh --dev"
        if is_skipped:
            print(f"skipped: {name} {reason}")
        else:
            self.add(name, failure(reason), 0.0)

    def conclude(self) -> int:
        for complaint in self._failures:
            print(complaint)
        print(self._total)
        return 0 if self._total.passed and not self._total.failed else 1


def indented_tail(path: Path, lines: int = 60) -> str:
    return "\n".join("  | " + line for line in path.read_text(errors="replace").splitlines()[-lines:])


class RosTests:
    """Runs .test files in parallel."""

    def __init__(self, folder: Path, account: RunSummary):
        self._folder, self._account = folder, account
        self._running: List[RosTest] = []
        self._is_ended = False
        self._lock = threading.Lock()

    def run(self, paths: Sequence[Path], jobs: int) -> None:
        with ThreadPoolExecutor(jobs) as pool:
            try:
                for done in as_completed([pool.submit(self._run, path) for path in paths]):
                    done.result()
            except BaseException:
                self._end()
                raise

    def _run(self, path: Path) -> None:
        with self._lock:
            if self._is_ended:
                return
            test = RosTest(self._folder, path)
            self._running.append(test)
        outcome, seconds = test.wait()
        with self._lock:
            self._running.remove(test)
            if not self._is_ended:
                self._account.add(test.name, outcome, seconds)

    def _end(self) -> None:
        with self._lock:
            self._is_ended = True
            for test in self._running:
                test.end()


def matching(paths, names: Sequence[str]) -> List[Path]:
    relative = {path: path.relative_to(ROOT).as_posix() for path in paths}
    return sorted(path for path, text in relative.items() if not names or any(name in text for name in names))


def main() -> int:
    parser = argparse.ArgumentParser(prog="test.sh", description="Runs the tests.")
    parser.add_argument("kind", nargs="?", choices=("unit", "ros", "all"), default="all")
    parser.add_argument("names", nargs="*", metavar="NAME", help="only test files whose paths contain it")
    parser.add_argument(
        "--quick", action="store_true", help="skip tests whose requirements are not installed"
    )
    usual = min(len(os.sched_getaffinity(0)), MOST_JOBS)
    parser.add_argument("--jobs", type=count, default=usual, help="files of ROS tests at once (%(default)s)")
    options = parser.parse_intermixed_args()

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
    account = RunSummary(folder)
    if unit:
        started = time.monotonic()
        outcome = run_unit_tests(folder, options.names)
        account.add("unit", outcome, time.monotonic() - started)
    lacks = {path: missing_requirement(path) for path in ros}
    RosTests(folder, account).run([path for path in ros if lacks[path] is None], options.jobs)
    for path, need in lacks.items():
        if need is not None:
            account.add_missing(path.relative_to(ROOT).as_posix(), need, options.quick)
    return account.conclude()


if __name__ == "__main__":
    on_signals(signal.default_int_handler)
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        sys.exit(130)
