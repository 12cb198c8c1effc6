"""Results of the checks of a course project."""

from dataclasses import dataclass, field
from typing import List, Optional

from evaluation.verdict import Verdict


@dataclass(frozen=True)
class Check:
    """Result of one check, with a description."""

    passed: bool
    description: str


@dataclass
class CheckResults:
    """All checks of a course project, in order."""

    checks: List[Check] = field(default_factory=list)

    def add(self, passed: bool, description: str) -> str:
        """Add a check; returns its description."""
        self.checks.append(Check(passed, description))
        return description

    def verdict(self, failure: Optional[str] = None) -> Verdict:
        """Success if there was a check and all passed.

        Args:
            failure: Why the run was cut short, if it was.
        """
        passed = sum(check.passed for check in self.checks)
        summary = "; ".join(check.description for check in self.checks) or "nothing checked"
        if failure:
            return Verdict(False, f"{failure}; {summary}")
        return Verdict(
            0 < passed == len(self.checks), f"{passed} of {len(self.checks)} checks passed: {summary}"
        )
