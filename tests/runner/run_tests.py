"""Run the unit tests and the ROS tests with pytest, and print one summary line.

The exit codes of ``rostest`` and ``catkin_make run_tests`` do not show whether every test ran, so the result
comes from the reports: a test file without a report of its tests has failed.
"""

import os
import signal
import sys
import time
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Iterable, List, Optional, Sequence, Tuple

import psutil
import pytest
from containment import GRACE_SECONDS, ROOT, run_contained
from outcome import Outcome, failure, judge_unit_tests
from ros_test import log_of
from rostest_plugin import Totals, indented_tail

from supervision.command_line import argument, count, option, parse
from supervision.display import print_error
from supervision.interruption import INTERRUPTED, on_signals
from supervision.processes import adopt_orphans

UNIT_SECONDS = 1800.0  # on a busy machine; usually a minute
MOST_JOBS = 4
UNIT_PLACES = ("src/**/test", "tests/runner", "tests/repository", "tests/fuzz", "tests/conformance")
KINDS = ("unit", "ros", "all")


@dataclass(frozen=True)
class Test:
    """Run the tests: unit tests (pytest, no ROS), ROS tests (rostest: nodes and whole missions), or both.

    The first word may be unit, ros or all, the default. Sets up all that the tests need, as
    ./scripts/setup.sh --dev does. Logs and JUnit reports: logs/tests/.

    Exit code: 0 all passed, 1 failure, 2 invalid usage, 130 interrupted.
    """

    names: Tuple[str, ...] = argument(
        "unit, ros or all; then only test files whose paths contain one of the others",
        default=(),
        nargs="*",
        metavar="NAME",
    )
    quick: bool = option(
        False,
        "without that: skip tests of what only ./scripts/setup.sh --dev installs, if it is not there",
    )
    jobs: Optional[int] = option(
        None,
        f"number of ROS test files run at the same time (default: three for two cores, at most {MOST_JOBS})",
        type=count,
    )


def run_unit_tests(folder: Path, names: Sequence[str]) -> Outcome:
    """Run the unit tests whose paths contain a name, in a process that ends all they leave behind."""
    report = folder / "unit.xml"
    selection = [f"--only={name}" for name in names]
    command = [sys.executable, "-m", "pytest", "-n", "auto", "--dist", "worksteal", f"--junitxml={report}"]
    started, log = time.monotonic(), log_of(folder, "unit")
    outcome = run_contained(
        [*command, *selection], log, UNIT_SECONDS, lambda code: judge_unit_tests(report, code)
    )
    print(f"unit: {outcome} ({time.monotonic() - started:.0f} s)", flush=True)
    if outcome.failed:
        print(f"{indented_tail(log)}\nFAILED unit: see {log}")
    return outcome


def run_ros_tests(folder: Path, paths: Sequence[Path], jobs: int, is_quick: bool) -> Outcome:
    """Run .test files in parallel.

    Raises:
        KeyboardInterrupt: After all that was started has ended.
    """
    adopt_orphans()
    totals = Totals()
    options = [
        "-vv",
        "-rs",
        "--no-header",
        "-Wignore::pytest.PytestAssertRewriteWarning",
        f"--ros-logs={folder}",
        f"--junitxml={folder / 'ros.xml'}",
    ]
    options += ["--quick"] if is_quick else []
    options += ["-n", str(jobs), "--dist", "worksteal"] if min(jobs, len(paths)) > 1 else ["-p", "no:xdist"]
    code = pytest.main([*options, *map(str, paths)], plugins=[totals])
    if code == pytest.ExitCode.INTERRUPTED:
        psutil.wait_procs(psutil.Process().children(recursive=True), timeout=2.0 * GRACE_SECONDS)
        raise KeyboardInterrupt
    if code not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED) and not totals.outcome.failed:
        return totals.outcome + failure(f"pytest ended with exit code {code}")
    return totals.outcome


def _jobs_for(cores: int) -> int:
    """Return how many ROS tests to run at a time: they wait, for starts and deadlines, for a third of it."""
    return min(cores + cores // 2, MOST_JOBS)


def matching(paths: Iterable[Path], names: Sequence[str]) -> List[Path]:
    relative = {path: path.relative_to(ROOT).as_posix() for path in paths}
    return sorted(path for path, text in relative.items() if not names or any(name in text for name in names))


def main() -> int:
    options = parse(Test, sys.argv[1:], "test.sh")
    has_kind = options.names[:1] and options.names[0] in KINDS
    kind, names = (options.names[0], options.names[1:]) if has_kind else ("all", options.names)
    unit = [path for place in UNIT_PLACES for path in ROOT.glob(f"{place}/test_*.py")]
    unit = matching(unit, names) if kind in ("unit", "all") else []
    ros = matching(ROOT.glob("tests/**/*.test"), names) if kind in ("ros", "all") else []
    if not unit and not ros:
        print_error(f"no test file matches {' '.join(names)}")
        return 2
    folder = ROOT / "logs" / "tests" / f"{datetime.now():%Y%m%d-%H%M%S}-{os.getpid()}"
    folder.mkdir(parents=True)
    outcome = run_unit_tests(folder, names) if unit else Outcome()
    if ros:
        jobs = options.jobs or _jobs_for(len(os.sched_getaffinity(0)))
        outcome += run_ros_tests(folder, ros, jobs, options.quick)
    for reason in outcome.reasons:
        print(f"FAILED  {reason}")
    print(outcome)
    return 0 if outcome.passed and not outcome.failed else 1


if __name__ == "__main__":
    on_signals(signal.default_int_handler)
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        sys.exit(INTERRUPTED)
