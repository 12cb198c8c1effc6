"""Numbers in messages, and their values over time (rqt_plot)."""

import math
import re
from collections import deque
from typing import Any, Deque, Dict, List, Mapping, Sequence, Tuple

import numpy as np

from cockpit.errors import CockpitError

MOST_SAMPLES, MOST_DRAWN = 6000, 1000
MOST_LISTED, LONGEST_LISTED, DEEPEST = 120, 6, 6
# Numbers of each topic that are suggested before a topic is selected.
MOST_SUGGESTED = 30
STEP = re.compile(r"(\w+)((?:\[-?\d+\])*)")


def expanded(word: str) -> List[str]:
    """Expand a field path of rqt_plot: "/pose/x:y" and "/pose/x,/pose/y" are two numbers each."""
    found = []
    for part in filter(None, word.split(",")):
        first, *others = part.split(":")
        above = first.rpartition("/")[0]
        found += [first, *(f"{above}/{other}" for other in others if other)]
    return found


def number_at(message: Any, path: str) -> float:
    """Return a number in a message.

    Args:
        message: A ROS message.
        path: Path of the field, such as ``twist.linear.x`` or ``ranges[3]``.

    Raises:
        CockpitError: There is no number at the path.
    """
    value = message
    for word in path.split("."):
        matched = STEP.fullmatch(word)
        if matched is None or not hasattr(value, "__slots__") or matched.group(1) not in value.__slots__:
            raise CockpitError(f"there is no field '{path}'")
        value = getattr(value, matched.group(1))
        for index in re.findall(r"-?\d+", matched.group(2)):
            try:
                value = value[int(index)]
            except (IndexError, TypeError, KeyError):
                raise CockpitError(f"there is no element [{index}] in '{path}'") from None
    if hasattr(value, "to_sec"):
        value = value.to_sec()
    if not isinstance(value, (bool, int, float, np.number, np.bool_)):
        raise CockpitError(f"'{path}' is not a number")
    return float(value)


def numbers_in(message: Any, depth: int = DEEPEST) -> List[str]:
    """Return the paths of the numbers in a message, with the first elements of arrays, headers last."""
    found = sorted(_numbers(message, "", depth), key=lambda path: "header" in path.split("."))
    return found[:MOST_LISTED]


def suggested(numbers: Mapping[str, Sequence[str]]) -> List[Tuple[str, str]]:
    """Return the first numbers of each topic, without headers.

    Args:
        numbers: Paths of the numbers in each topic, as returned by ``numbers_in``.

    Returns:
        Topic and path of each number.
    """
    return [
        (topic, path)
        for topic, paths in numbers.items()
        for path in paths[:MOST_SUGGESTED]
        if "header" not in path.split(".")
    ]


def _numbers(value: Any, path: str, depth: int) -> List[str]:
    if hasattr(value, "to_sec") or isinstance(value, (bool, int, float, np.number, np.bool_)):
        return [path]
    if depth == 0:
        return []
    found: List[str] = []
    if hasattr(value, "__slots__"):
        for name in value.__slots__:
            if not name.startswith("_"):
                found += _numbers(getattr(value, name), f"{path}.{name}".lstrip("."), depth - 1)
    elif isinstance(value, (list, tuple, np.ndarray)):
        for index, item in enumerate(value[:LONGEST_LISTED]):
            found += _numbers(item, f"{path}[{index}]", depth - 1)
    return found


class TimeSeries:
    """Named series of timed numbers.

    Attributes:
        seconds: Plotted time span [s].
    """

    def __init__(self, seconds: float):
        self.seconds = seconds
        self._samples: Dict[str, Deque[Tuple[float, float]]] = {}

    def add(self, name: str, at: float, value: float) -> None:
        """Add a sample; one that is not finite is ignored.

        Args:
            name: Name of the series.
            at: Steady-clock time [s].
            value: The number.
        """
        samples = self._samples.setdefault(name, deque(maxlen=MOST_SAMPLES))
        if math.isfinite(value):
            samples.append((at, value))

    def remove(self, name: str) -> None:
        self._samples.pop(name, None)

    def newest(self, name: str) -> float:
        """Return the newest value; NaN if there is none."""
        samples = self._samples.get(name)
        return samples[-1][1] if samples else math.nan

    def drawn(self, names: List[str], now: float) -> Tuple[np.ndarray, ...]:
        """Resample series for plotting.

        Args:
            names: Names of the series.
            now: Steady-clock time [s].

        Returns:
            Times (N,) relative to ``now`` [s], then the values (N,) of each series, held until the next.
        """
        taken = [np.array(self._samples.get(name, ())).reshape(-1, 2) for name in names]
        times = np.unique(np.concatenate([np.array([now]), *(samples[:, 0] for samples in taken)]))
        times = times[times >= now - self.seconds]
        if len(times) > MOST_DRAWN:
            times = times[np.unique(np.linspace(0, len(times) - 1, MOST_DRAWN).astype(int))]
        return (times - now, *(_held(samples, times) for samples in taken))


def _held(samples: np.ndarray, times: np.ndarray) -> np.ndarray:
    if not len(samples):
        return np.zeros(len(times))
    which = np.searchsorted(samples[:, 0], times, side="right") - 1
    return samples[np.maximum(which, 0), 1]
