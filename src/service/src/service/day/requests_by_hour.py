"""Generated requests of a day: how many come at which hour, what they ask for, and by when."""

from dataclasses import dataclass
from typing import Any, Dict, List, Sequence, Tuple

import numpy as np

from service.requests.timed_requests import TimedRequest

# Expected share of the requests in each hour of a day: meals, mornings, evenings; nights are quiet.
SHARES = (1, 0, 0, 0, 0, 1, 4, 8, 7, 5, 4, 5, 8, 7, 4, 4, 5, 7, 9, 8, 6, 4, 2, 1)
CATEGORIES = (("deliver", 0.6), ("go", 0.15), ("patrol", 0.1), ("wait", 0.1), ("dock", 0.05))
PEOPLE = ("anna", "ben", "carla", "david")


@dataclass(frozen=True)
class DaySettings:
    """How busy a day is.

    Attributes:
        requests: Number of requests.
        deadline_share: Share that has a deadline.
        slack_minutes: Shortest and longest time from the earliest start to the deadline [min].
        ahead_share: Share that is asked for hours ahead.
        objects: Number of objects in the home.
    """

    requests: int = 60
    deadline_share: float = 0.7
    slack_minutes: Tuple[float, float] = (4.0, 45.0)
    ahead_share: float = 0.25
    objects: int = 12


class DayGenerator:
    """Makes the requests of a day; equal seeds give equal days.

    Args:
        places: Names of the places.
        rng: Chance.
        settings: How busy the day is.
    """

    def __init__(
        self, places: Sequence[str], rng: np.random.Generator, settings: DaySettings = DaySettings()
    ):
        self._places, self._rng, self._settings = list(places), rng, settings
        self._where = {f"object{n}": self._choose(self._places) for n in range(settings.objects)}

    def requests(self, midnight: float) -> List[TimedRequest]:
        """Return the requests of a day in the order in which they are sent.

        Args:
            midnight: Unix time of its begin [s].
        """
        shares = np.array(SHARES) / sum(SHARES)
        counts = self._rng.multinomial(self._settings.requests, shares)
        due = sorted(
            midnight + 3600.0 * (hour + self._rng.random())
            for hour, count in enumerate(counts)
            for _ in range(count)
        )
        made = [self._request(stamp) for stamp in due]
        return sorted(made, key=lambda request: request.stamp)

    def _request(self, due: float) -> TimedRequest:
        settings, rng = self._settings, self._rng
        is_ahead = rng.random() < settings.ahead_share
        category = str(rng.choice([name for name, _ in CATEGORIES], p=[share for _, share in CATEGORIES]))
        # The objects are where the requests before leave them: what moves one must not overtake another.
        is_ahead = is_ahead and category != "deliver"
        document: Dict[str, Any] = {
            "category": category,
            "description": self._description(category),
            "priority": int(rng.choice([0, 1, 2], p=[0.8, 0.15, 0.05])),
            "requester": self._choose(PEOPLE),
        }
        if is_ahead:
            document["unix_millis_earliest_start_time"] = round(1000.0 * due)
        if rng.random() < settings.deadline_share:
            slack = 60.0 * rng.uniform(*settings.slack_minutes)
            document["unix_millis_deadline"] = round(1000.0 * (due + slack))
        return TimedRequest(due - (3600.0 * rng.uniform(0.5, 4.0) if is_ahead else 0.0), document)

    def _description(self, category: str) -> Dict[str, Any]:
        places, rng = self._places, self._rng
        if category == "deliver":
            name = self._choose(sorted(self._where))
            source = self._where[name]
            self._where[name] = destination = self._choose([place for place in places if place != source])
            return {"object": name, "from": source, "to": destination}
        if category == "patrol":
            return {"places": [str(place) for place in rng.permutation(places)[: rng.integers(2, 5)]]}
        if category == "wait":
            return {"seconds": float(rng.integers(10, 120)), "place": self._choose(places)}
        return {"place": self._choose(places)} if category == "go" else {}

    def _choose(self, values: Sequence[str]) -> str:
        return str(values[int(self._rng.integers(len(values)))])
