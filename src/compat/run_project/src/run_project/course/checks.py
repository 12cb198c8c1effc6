"""How a lesson went: what was tried with the robot, one after the other, and whether it did that."""

from dataclasses import dataclass, field
from typing import List, Optional

from run_project.judging.verdict import ProjectVerdict


@dataclass(frozen=True)
class Check:
    """One thing tried, in words, with what came of it."""

    passed: bool
    description: str


@dataclass
class CheckResults:
    """All trials of a lesson."""

    checks: List[Check] = field(default_factory=list)

    def add(self, passed: bool, description: str) -> str:
        """Adds a trial; returns what is told of it."""
        self.checks.append(Check(passed, description))
        return description

    def verdict(self, failure: Optional[str] = None) -> ProjectVerdict:
        """Success if something was tried and all of it went well; ``failure``: why it was cut short."""
        good = sum(check.passed for check in self.checks)
        story = "; ".join(check.description for check in self.checks) or "nothing tried"
        if failure:
            return ProjectVerdict(False, f"{failure}; {story}")
        return ProjectVerdict(0 < good == len(self.checks), f"{good} of {len(self.checks)} as meant: {story}")
