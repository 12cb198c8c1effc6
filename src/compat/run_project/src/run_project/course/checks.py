"""Checks of a course project: what they measure, and their results."""

import math
from dataclasses import dataclass, field
from typing import List, Optional

import numpy as np

from evaluation.verdict import Verdict
from planar import Pose2


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


def camera_pose(matrix: np.ndarray, is_optical: bool) -> Pose2:
    """Pose of a camera in the plane, x in its direction of view.

    Args:
        matrix: Pose (4, 4) of the camera's frame in the frame of the base.
        is_optical: Whether the frame has z in the direction of view, as in REP 103, instead of x.
    """
    view = matrix[:3, 2 if is_optical else 0]
    return Pose2(float(matrix[0, 3]), float(matrix[1, 3]), math.atan2(view[1], view[0]))
