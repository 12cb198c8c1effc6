"""Let pytest collect .test files: each is one item, run by rostest in a contained child process."""

import shutil
from dataclasses import astuple
from datetime import datetime
from importlib.util import find_spec
from pathlib import Path
from typing import Iterator, Optional, Tuple

import psutil
import pytest
from containment import ROOT
from outcome import Outcome, failure
from ros_test import RosTest, log_of

TAIL_LINES = 60
# Requirements that scripts/setup.sh --dev installs, by test file or folder: one command or
# package of each group.
BROWSERS, PAGE = ("chromium", "chromium-browser", "google-chrome"), ("viser",)
NEEDS = {
    "tests/cockpit": (BROWSERS, PAGE),
    "tests/home_builder": (BROWSERS,),
    "tests/two_hosts": (("ip",),),
    "tests/two_hosts/cockpit_alone.test": (BROWSERS, PAGE),
    "tests/two_hosts/laboratory_two_hosts.test": (("distributed",),),
}
# Property of a report: the outcome of the tests in the file.
OUTCOME = "outcome"


class RosTestError(Exception):
    """A test of a file failed; the text has the reason, the log's path and its end."""


class RosTestFile(pytest.File):
    """A .test file."""

    def collect(self) -> "Iterator[RosTestItem]":
        yield RosTestItem.from_parent(self, name=self.path.stem)


class RosTestItem(pytest.Item):
    """The tests of a .test file."""

    def setup(self) -> None:
        lacking = missing_requirement(self.path)
        if lacking is None:
            return
        reason = f"needs {lacking}; run ./scripts/setup.sh --dev"
        if self.config.getoption("quick"):
            pytest.skip(reason)
        pytest.fail(reason, pytrace=False)

    def runtest(self) -> None:
        folder = Path(self.config.getoption("ros_logs"))
        folder.mkdir(parents=True, exist_ok=True)
        test = RosTest(folder, self.path)
        outcome = test.wait()
        self.user_properties.append((OUTCOME, astuple(outcome)))
        if outcome.failed:
            log = log_of(folder, test.name)
            tail = indented_tail(log) if log.exists() else ""  # a terminated test may have no log
            raise RosTestError(f"{outcome.reason or 'see the log'} -- {log}\n{tail}")

    def repr_failure(self, excinfo, style=None):
        if isinstance(excinfo.value, RosTestError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> Tuple[Path, None, str]:
        return self.path, None, self.path.relative_to(ROOT).as_posix()


def pytest_addoption(parser) -> None:
    group = parser.getgroup("ROS", "ROS tests")
    logs = str(ROOT / f"logs/tests/{datetime.now():%Y%m%d-%H%M%S}")
    group.addoption("--ros-logs", default=logs, metavar="FOLDER", help="logs and reports of .test files")
    group.addoption("--quick", action="store_true", help="skip .test files that need what is not installed")


def pytest_collect_file(file_path: Path, parent) -> Optional[RosTestFile]:
    return RosTestFile.from_parent(parent, path=file_path) if file_path.suffix == ".test" else None


def pytest_report_teststatus(report, config) -> Optional[Tuple[str, str, str]]:
    """Show how the tests of a file ended, and how long they took."""
    found = outcome_of(report)
    if found is None:
        return None
    word = f"{found} ({report.duration:.0f} s)"
    return ("failed", "F", word) if report.failed else ("passed", ".", word)


def pytest_keyboard_interrupt() -> None:
    """End the workers at once; the child process of each then ends what it has started, and itself."""
    for worker in psutil.Process().children():
        worker.kill()


def outcome_of(report) -> Optional[Outcome]:
    """Return the outcome of the tests in a .test file; None for other reports."""
    found = dict(report.user_properties).get(OUTCOME) if report.when == "call" else None
    if found is None:
        return None
    passed, failed, skipped, reasons = found
    return Outcome(passed, failed, skipped, tuple(reasons))


class Totals:
    """Plugin that sums the outcomes of the tests in .test files; a file that did not run counts as one."""

    def __init__(self) -> None:
        self.outcome = Outcome()

    def pytest_runtest_logreport(self, report) -> None:
        found = outcome_of(report)
        if found is None and report.failed:
            found = failure(f"{report.location[2]}: {str(report.longrepr).strip().splitlines()[-1]}")
        self.outcome += found or Outcome()


def is_installed(name: str) -> bool:
    return shutil.which(name) is not None or find_spec(name) is not None


def missing_requirement(path: Path, is_there=is_installed) -> Optional[str]:
    """Return a requirement of a .test file that is not installed, or None."""
    place = path.relative_to(ROOT)
    for group in (*NEEDS.get(place.parent.as_posix(), ()), *NEEDS.get(place.as_posix(), ())):
        if not any(map(is_there, group)):
            return group[0]
    return None


def indented_tail(path: Path) -> str:
    return "\n".join("  | " + line for line in path.read_text(errors="replace").splitlines()[-TAIL_LINES:])
