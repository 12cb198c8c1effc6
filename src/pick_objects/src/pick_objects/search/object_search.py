"""Search for one object: the posterior over furniture tops, and the order of looks.

The optimal searcher path problem (Trummel and Weisinger, "The complexity of the optimal searcher path
problem", 1986) with detection probabilities below 1, solved by beam search, again after each look.
"""

from typing import Dict, List, Optional, Tuple

import numpy as np

from pick_objects.search.area import SearchArea
from planar import Pose2

# Number of looks that are planned ahead, and of sequences that are kept at each.
DEPTH, BEAM = 8, 24
# Time by which what is not found within the planned looks is charged [s].
TAIL_SECONDS = 30.0
# Share of what can be seen that was seen when the search ends, by the prior and on each point alike: the
# probability of detection, had the object been there.
COVERAGE, EVEN_COVERAGE = 0.95, 0.9
# Least probability of detection of a look that is worth it, and that with which a point counts as looked at.
MIN_GAIN, SEEN = 1e-3, 0.3


class ObjectSearch:
    """State of a search.

    Args:
        area: Views and furniture.
        object_name: What is searched.

    Attributes:
        area: As given.
        object_name: As given.
        looks: Number of looks that were taken.
        mass: Prior probability of each point, times that of having missed the object there so far (N,).

    Raises:
        SettingsError: The semantic map does not list the object.
    """

    def __init__(self, area: SearchArea, object_name: str):
        self.area, self.object_name, self.looks = area, object_name, 0
        prior = area.semantic_map.probabilities(object_name)
        by_top = np.array([prior[top.name] for top in area.tops])
        self.mass = by_top[area.top_of_point] / np.bincount(area.top_of_point)[area.top_of_point]
        self._prior = self.mass
        self._is_allowed = np.ones(len(area.views), dtype=bool)
        self._shown = np.zeros(len(self.mass))

    def next_view(self, base_in_map: Pose2) -> Optional[int]:
        """Return the index of the view to look from next; None if the search has ended without success.

        Args:
            base_in_map: Where the robot is.
        """
        if self.is_over(base_in_map):
            return None
        area, seconds = self.area, self.area.seconds_to_views(base_in_map)
        is_possible = self._is_allowed & np.isfinite(seconds)
        return _best_first(seconds, area.seconds_between_views, area.detection, self.mass, is_possible)

    def is_over(self, base_in_map: Pose2) -> bool:
        """Return whether what can be seen was seen.

        Args:
            base_in_map: Where the robot is.
        """
        is_possible = self._is_allowed & np.isfinite(self.area.seconds_to_views(base_in_map))
        can_see = self.area.detection[is_possible].max(axis=0, initial=0.0) > 0.0
        if not can_see.any():
            return True
        missed, prior = self.mass[can_see].sum(), self._prior[can_see].sum()
        missed_on_average = (self.mass[can_see] / self._prior[can_see]).mean()
        return bool(missed <= (1.0 - COVERAGE) * prior and missed_on_average <= 1.0 - EVEN_COVERAGE)

    def on_nothing_seen(self, view: int) -> None:
        """Update the posterior after a look that did not detect the object (Bayes' rule)."""
        self.looks += 1
        self.mass = self.mass * (1.0 - self.area.detection[view])
        self._shown = np.maximum(self._shown, self.area.detection[view])

    def on_unreachable(self, view: int) -> None:
        """Exclude a view that the robot could not reach."""
        self._is_allowed[view] = False

    def posterior(self) -> Dict[str, float]:
        """Return the probability of each piece of furniture, given that the object is on one of them."""
        by_top = np.bincount(self.area.top_of_point, self.mass, len(self.area.tops))
        total = max(by_top.sum(), np.finfo(float).tiny)
        return {top.name: float(each / total) for top, each in zip(self.area.tops, by_top)}

    def names_looked_at(self) -> Tuple[List[str], List[str]]:
        """Return the furniture that was looked at, and that of which nothing was seen."""
        seen = np.bincount(self.area.top_of_point, self._shown > SEEN, len(self.area.tops)) > 0.0
        names = [top.name for top in self.area.tops]
        return (
            [name for name, is_seen in zip(names, seen) if is_seen],
            [name for name, is_seen in zip(names, seen) if not is_seen],
        )

    def furniture_shown_by(self, view: int) -> str:
        """Return the name of the furniture of which a look from a view is most likely to show the object."""
        gains = np.bincount(
            self.area.top_of_point, self.mass * self.area.detection[view], len(self.area.tops)
        )
        return self.area.tops[int(gains.argmax())].name


def _best_first(
    from_robot: np.ndarray,
    between: np.ndarray,
    detection: np.ndarray,
    mass: np.ndarray,
    is_possible: np.ndarray,
) -> Optional[int]:
    """Return the first view of the sequence of looks with the least expected time to detection.

    Args:
        from_robot: Time from the robot to each view, (V,) [s].
        between: Time from each view to each, (V, V) [s].
        detection: Probability of detection at each point from each view, (V, N).
        mass: Probability of each point, (N,).
        is_possible: Views that may be chosen, (V,).
    """
    first = np.full(1, -1)
    masses, costs, seconds = mass[None, :], np.zeros(1), from_robot[None, :]
    best: Optional[int] = None
    for _ in range(DEPTH):
        gains = masses @ detection.T
        left = masses.sum(axis=1)
        further = costs[:, None] + left[:, None] * seconds
        is_open = is_possible & (gains >= MIN_GAIN) & np.isfinite(seconds)
        scores = np.where(is_open, further + (left[:, None] - gains) * TAIL_SECONDS, np.inf)
        order = np.argsort(scores, axis=None, kind="stable")[:BEAM]
        states, views = np.unravel_index(order[np.isfinite(scores.ravel()[order])], scores.shape)
        if not len(views):
            break
        first = np.where(first[states] < 0, views, first[states])
        masses, costs = masses[states] * (1.0 - detection[views]), further[states, views]
        seconds, best = between[views], int(first[0])
    return best
