"""The contract of a matcher of scans to the scans before, and which one the settings choose.

One of somebody's own is chosen by ``matcher_plugin: my_package.my_module/MyMatcher``. Places are recognised
and loops are closed without it.
"""

import copy
import math
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from planar import PlanarError, Pose2
from planar.plugins import PluginContract, errors_raised_as, load_plugin
from slam_lite.config import MapperSettings
from slam_lite.matching.correlative import Window, search_near
from slam_lite.matching.local_map import LocalMap, Match
from slam_lite.matching.refinement import refine
from slam_lite.surface import Surface

# What is less than this share of the largest entry of an information matrix is rounding.
_ROUNDING = 1e-6


class MatchingError(PlanarError):
    """A scan could not be matched, because of a matcher of somebody's own."""


@dataclass(frozen=True, eq=False)
class Prediction:
    """Where a scan is believed to have been taken: ``base_pose`` in the local map's frame.

    ``variance``: (3,), m^2, m^2, rad^2, of what odometry told; ``doubt``: the same, but larger where odometry
    told of no motion and may be wrong in that. ``new_share``: share of the scan, 0 to 1, that looks where the
    last one that was kept did not, and fits nothing in the map.
    """

    base_pose: Pose2
    variance: np.ndarray
    doubt: np.ndarray
    new_share: float = 0.0

    @property
    def information(self) -> np.ndarray:
        """(3, 3), of what odometry told."""
        return np.diag(1.0 / self.variance)


class ScanMatcher(Protocol):
    """Made for each trajectory: at the start, and where the robot is found anew."""

    def __init__(self, settings: MapperSettings): ...

    def match(self, surface: Surface, local_map: LocalMap, prediction: Prediction) -> Match:
        """Where the scan fits the map, near the prediction and not without regard to it.

        A response that is poor is tried again in a wide window; with less than ``min_response`` odometry is
        believed.
        """
        ...


CONTRACT = PluginContract("scan matcher", ScanMatcher, MapperSettings, "slam_lite.scan_matchers")


def scan_matcher_of(settings: MapperSettings) -> ScanMatcher:
    """Raises MatchingError if one of somebody's own cannot be made."""
    return GuardedMatcher(settings) if settings.matcher_plugin else CorrelativeMatcher(settings)


class CorrelativeMatcher:
    """The project's own: the best pose of a window, then the lines that its points lie on."""

    def __init__(self, settings: MapperSettings):
        pass

    def match(self, surface: Surface, local_map: LocalMap, prediction: Prediction) -> Match:
        predicted, variance = prediction.base_pose, prediction.variance
        window = Window(
            float(np.clip(3.0 * math.sqrt(variance[0]), 0.1, 0.4)),
            float(np.clip(3.0 * math.sqrt(variance[2]), 0.1, 0.5)),
        )
        start = search_near(surface, local_map, predicted, window, prediction.doubt, prediction.new_share)
        return refine(surface, local_map, start, predicted, prediction.information)


class GuardedMatcher:
    """One of other people: it can change nothing, what it gives is checked, what goes wrong is its fault."""

    def __init__(self, settings: MapperSettings):
        """Raises SettingsError with what it lacks, MatchingError if it cannot be made."""
        self._name = settings.matcher_plugin
        make: Any = load_plugin(self._name, CONTRACT)
        with errors_raised_as(self._name, MatchingError):
            self._matcher = make(settings)

    def match(self, surface: Surface, local_map: LocalMap, prediction: Prediction) -> Match:
        """Raises MatchingError."""
        with errors_raised_as(self._name, MatchingError):
            match = self._matcher.match(_to_read(surface), _to_read(local_map), _to_read(prediction))
            complaint = _complaint_about(match)
        if complaint:
            raise MatchingError(f"{self._name} gave {complaint}")
        return match


def _to_read(lent: Any) -> Any:
    """The same with arrays that cannot be written."""
    shown = copy.copy(lent)
    for name, value in vars(lent).items():
        if isinstance(value, np.ndarray):
            view = value.view()
            view.flags.writeable = False
            object.__setattr__(shown, name, view)
        elif isinstance(value, LocalMap):
            object.__setattr__(shown, name, _to_read(value))
    return shown


def _complaint_about(match: Any) -> str:
    """What is wrong with an answer, for people; nothing if it can be used."""
    if not isinstance(match, Match):
        return f"a {type(match).__name__}, not a Match"
    if not (isinstance(match.base_pose, Pose2) and match.base_pose.is_in_range()):
        return f"a base_pose at which no robot can be: {match.base_pose}"
    information = np.asarray(match.information)
    if information.shape != (3, 3) or not np.isfinite(information).all():
        return "an information that is no 3 by 3 finite numbers"
    rounding = _ROUNDING * np.abs(information).max()
    is_symmetric = np.allclose(information, information.T, rtol=0.0, atol=rounding)
    if not (is_symmetric and np.linalg.eigvalsh(information)[0] >= -rounding):
        return "an information that is not symmetric, or negative in some direction"
    return "" if 0.0 <= match.response <= 1.0 else f"a response of {match.response:g}, not of 0 to 1"
