"""Recordings that consist of several bags."""

import math
from pathlib import Path
from typing import Dict, Iterable, Iterator, List, Sequence, Set, Tuple

from planar_ros.bags.bag_reader import BagError, BagReader, RecordedMessage


class Recording:
    """Consecutive bags read as one recording, in time order.

    Args:
        paths: Bag files, or folders that contain bags.

    Attributes:
        paths: All bag files, in the order given.
        truncations: For each truncated bag its name and where it is cut off, for messages to people.
        start: Time of the first message [s].
        end: Time of the last message [s].

    Raises:
        BagError: If a path has no bag, a bag is unreadable, or no bag has a message.
    """

    def __init__(self, paths: Sequence[Path]):
        self.paths = bag_paths(paths)
        bags = [BagReader(path) for path in self.paths]
        self.truncations: List[str] = [f"{bag.path.name}: {bag.truncation}" for bag in bags if bag.truncation]
        self._bags = sorted((bag for bag in bags if not bag.is_empty), key=lambda bag: bag.start)
        if not self._bags:
            raise BagError(f"{self.paths[0]}: the bag has no messages")
        self.start, self.end = self._bags[0].start, max(bag.end for bag in self._bags)

    @property
    def types(self) -> Dict[str, str]:
        """Message type of each topic."""
        return {topic: kind for bag in self._bags for topic, kind in bag.types.items()}

    @property
    def unavailable_topics(self) -> Set[str]:
        """Topics whose message type is not installed or differs from the recorded one."""
        return set().union(*(bag.unavailable_topics for bag in self._bags))

    def topics_of(self, *types: str) -> List[str]:
        """Return the topics with one of these message types, sorted by name."""
        return sorted(topic for topic, kind in self.types.items() if kind in types)

    def messages(
        self, topics: Iterable[str], since: float = 0.0, until: float = math.inf
    ) -> Iterator[RecordedMessage]:
        """Iterate over the messages of some topics, bag by bag in recorded order.

        Args:
            topics: Topic names.
            since: Start of the time interval [s], inclusive.
            until: End of the time interval [s], inclusive.

        Yields:
            The messages recorded within the interval.

        Raises:
            BagError: Where a bag is broken.
        """
        topics = list(topics)
        for bag in self._bags:
            yield from bag.messages(topics, since, until)


def bag_paths(paths: Sequence[Path]) -> List[Path]:
    """Resolve bag files, folders of bags, and folders of runs (with bags in ``bag/``).

    Args:
        paths: Files and folders.

    Returns:
        The bag files, those of a folder sorted by name.

    Raises:
        BagError: If a path does not exist or a folder has no bag.
    """
    found: List[Path] = []
    for path in paths:
        if path.is_dir():
            inside = _bags_in(path) or _bags_in(path / "bag")
            if not inside:
                raise BagError(f"{path}: no bag in this folder")
            found += inside
        elif path.exists():
            found.append(path)
        else:
            raise BagError(f"{path}: no such bag")
    return found


def _bags_in(folder: Path) -> Tuple[Path, ...]:
    return tuple(sorted((*folder.glob("*.bag"), *folder.glob("*.bag.active"))))
