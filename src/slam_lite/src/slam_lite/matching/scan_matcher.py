"""The contract of scan matchers, and the choice of one by the settings.

A custom matcher is chosen by ``matcher_plugin: my_package.my_module/MyMatcher``. Place recognition and loop
closure do not use it.
"""

import math
import warnings
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from planar import PlanarError, Pose2
from planar.extensions import ExtensionPoint, InvalidAnswer
from slam_lite.matching.correlative import SearchWindow, search_exhaustively
from slam_lite.matching.local_map import LocalMap, Match
from slam_lite.matching.refinement import refine
from slam_lite.point_cloud import PointCloud

# Rounding error of an information matrix, as a share of its largest entry.
_ROUNDING = 1e-6


class MatchingError(PlanarError):
    """A custom scan matcher failed or returned an invalid result."""


@dataclass(frozen=True, eq=False)
class Prediction:
    """Pose at which a scan is expected, from odometry.

    Attributes:
        base_pose: Pose of the base in the frame of the local map.
        variance: (3,), of odometry [m^2, m^2, rad^2].
        search_variance: (3,), the same, but larger where odometry reports no motion and may be stuck.
        unseen_fraction: Fraction of the scan, 0 to 1, in directions that the last keyframe does not cover,
            and that matches nothing in the map.
    """

    base_pose: Pose2
    variance: np.ndarray
    search_variance: np.ndarray
    unseen_fraction: float = 0.0

    @property
    def information(self) -> np.ndarray:
        """Information (3, 3) of odometry, 1 / (m, m, rad)^2."""
        return np.diag(1.0 / self.variance)

    @property
    def doubt(self) -> np.ndarray:
        """Deprecated name of ``search_variance``."""
        warnings.warn("Prediction.doubt is deprecated; use search_variance", DeprecationWarning, stacklevel=2)
        return self.search_variance

    @property
    def new_share(self) -> float:
        """Deprecated name of ``unseen_fraction``."""
        message = "Prediction.new_share is deprecated; use unseen_fraction"
        warnings.warn(message, DeprecationWarning, stacklevel=2)
        return self.unseen_fraction


class ScanMatcher(Protocol):
    """Matches scans to a local map; one is created for each trajectory, also after relocalization."""

    def __init__(self, settings: Any): ...

    def match(self, cloud: PointCloud, local_map: LocalMap, prediction: Prediction) -> Match:
        """Find the pose near the prediction at which a scan matches the map.

        If the response is poor, a wide window is searched; below ``min_response`` odometry is used instead.
        The arguments are read-only.

        Args:
            cloud: Points and surface normals of the scan, in the base frame.
            local_map: Points of the keyframes around the robot.
            prediction: Pose from odometry, to be weighted against the scan.

        Returns:
            Pose of the base in the frame of the local map, its information and the response.
        """
        ...


def _checked(match: Any, *given: Any) -> Match:
    problem = _problem_of(match)
    if problem:
        raise InvalidAnswer(f"returned {problem}")
    return match


def _problem_of(match: Any) -> str:
    """What is wrong with a result, for people; empty if it can be used."""
    if not isinstance(match, Match):
        return f"a {type(match).__name__}, not a Match"
    if not (isinstance(match.base_pose, Pose2) and match.base_pose.is_in_range()):
        return f"a base_pose that is not a Pose2 in range: {match.base_pose}"
    information = np.asarray(match.information)
    if information.shape != (3, 3) or not np.isfinite(information).all():
        return "an information that is not a (3, 3) array of finite numbers"
    rounding = _ROUNDING * np.abs(information).max()
    is_symmetric = np.allclose(information, information.T, rtol=0.0, atol=rounding)
    if not (is_symmetric and np.linalg.eigvalsh(information)[0] >= -rounding):
        return "an information that is not symmetric and positive semi-definite"
    return "" if 0.0 <= match.response <= 1.0 else f"a response of {match.response:g}, not between 0 and 1"


CONTRACT: ExtensionPoint[ScanMatcher] = ExtensionPoint(
    "scan matcher", ScanMatcher, "slam_lite.scan_matchers", MatchingError, answers={"match": _checked}
)


def scan_matcher_of(settings: Any) -> ScanMatcher:
    """Create the matcher that the settings select.

    Args:
        settings: MapperSettings with ``matcher_plugin``, which are passed to the matcher.

    Raises:
        SettingsError: A custom matcher does not fulfil the contract.
        MatchingError: A custom matcher cannot be created.
    """
    if settings.matcher_plugin:
        return CONTRACT.make(settings.matcher_plugin, settings)
    return CorrelativeMatcher(settings)


class CorrelativeMatcher:
    """Default matcher: exhaustive search of a window, then point-to-line refinement."""

    def __init__(self, settings: Any):
        pass

    def match(self, cloud: PointCloud, local_map: LocalMap, prediction: Prediction) -> Match:
        """Search the window exhaustively and refine the best pose (see ``ScanMatcher.match``)."""
        predicted, variance = prediction.base_pose, prediction.variance
        window = SearchWindow(
            min(max(3.0 * math.sqrt(variance[0]), 0.1), 0.4),
            min(max(3.0 * math.sqrt(variance[2]), 0.1), 0.5),
        )
        start = search_exhaustively(
            cloud, local_map, predicted, window, prediction.search_variance, prediction.unseen_fraction
        )
        return refine(cloud, local_map, start, predicted, prediction.information)
