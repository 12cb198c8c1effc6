"""The outcome of a test file, read from the reports of its tests."""

from dataclasses import dataclass
from pathlib import Path
from typing import Sequence, Tuple
from xml.etree import ElementTree

NO_TESTS = 5  # pytest's exit code


@dataclass(frozen=True)
class Outcome:
    """Number of passed, failed and skipped tests, and the reasons of the failures."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0
    reasons: Tuple[str, ...] = ()

    @property
    def reason(self) -> str:
        return self.reasons[0] if self.reasons else ""

    def __add__(self, other: "Outcome") -> "Outcome":
        return Outcome(
            self.passed + other.passed,
            self.failed + other.failed,
            self.skipped + other.skipped,
            self.reasons + other.reasons,
        )

    def __str__(self) -> str:
        skipped = f", {self.skipped} skipped" if self.skipped else ""
        return f"{self.passed} passed, {self.failed} failed{skipped}"


def failure(reason: str) -> Outcome:
    return Outcome(failed=1, reasons=(reason,))


def read_report(path: Path) -> Outcome:
    """Sum the counts of a JUnit report over its suites, with the failures' messages."""
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
        failures_in(report),
    )


def failures_in(report: ElementTree.Element) -> Tuple[str, ...]:
    """Return name and message of each failed test."""
    found = []
    for case in report.iter("testcase"):
        for failed in (*case.iter("failure"), *case.iter("error")):
            # pytest's is an attribute; rosunit's stands before the traceback.
            message = failed.get("message") or (failed.text or "").strip().partition("\n")[0]
            found.append(f"{case.get('name')}: {' '.join(message.split())[:300]}")
    return tuple(found)


def judge_unit_tests(report: Path, exit_code: int) -> Outcome:
    outcome = read_report(report)
    if exit_code == NO_TESTS:
        return outcome + failure("all tests need packages that only ./scripts/setup.sh --dev installs")
    if exit_code != 0 and not outcome.failed:
        return outcome + failure(f"pytest ended with exit code {exit_code}")
    return outcome


def judge_ros_test(test_names: Sequence[str], reports: Path, exit_code: int) -> Outcome:
    """Sum the reports of the tests of one .test file; each must report at least one test."""
    total = Outcome()
    for name in test_names:
        found = sorted(reports.rglob(f"rosunit-{name}.xml"))
        outcome = read_report(found[0]) if found else failure(f"test '{name}' left no report")
        if outcome == Outcome():
            outcome = failure(f"test '{name}' ran no test")
        total += outcome
    if not test_names:
        total = failure("the file defines no test")
    for path in sorted(reports.rglob("rostest-*.xml")):
        if read_report(path).failed and not total.failed:
            total += failure("rostest reports a test that did not exit cleanly")
    if exit_code != 0 and not total.failed:
        total += failure(f"rostest ended with exit code {exit_code}")
    return total
