"""The bags of a recording, in the order of time."""

import math
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, Sequence, Set, Tuple

from planar_ros.bags.bag_reader import BagError, BagReader, RecordedMessage


class Recording:
    """Bags that follow each other; broken ones are read as far as they go.

    ``paths``: of all of them, as they were named. ``gaps`` says which ends are missing. Raises BagError.
    """

    def __init__(self, paths: Sequence[Path]):
        self.paths = bag_paths(paths)
        bags = [BagReader(path) for path in self.paths]
        self.truncations: List[str] = [f"{bag.path.name}: {bag.truncation}" for bag in bags if bag.truncation]
        self._bags = sorted((bag for bag in bags if not bag.is_empty), key=lambda bag: bag.start)
        if not self._bags:
            raise BagError(f"{self.paths[0]}: there is no message in it")
        self.start, self.end = self._bags[0].start, self._bags[-1].end

    @property
    def types(self) -> Dict[str, str]:
        """The type of each topic."""
        return {topic: kind for bag in self._bags for topic, kind in bag.types.items()}

    @property
    def unavailable_topics(self) -> Set[str]:
        """The topics whose types are not installed, or otherwise than they were recorded."""
        return set().union(*(bag.unavailable_topics for bag in self._bags))

    def topics_of(self, *types: str) -> List[str]:
        return sorted(topic for topic, kind in self.types.items() if kind in types)

    def messages(
        self, topics: Iterable[str], since: float = 0.0, until: float = math.inf
    ) -> Iterator[RecordedMessage]:
        """The messages of ``topics`` in the order in which they were recorded, and when. Raises BagError.

        ``since``, ``until``: those that were recorded between, both included, s.
        """
        topics = list(topics)
        for bag in self._bags:
            yield from bag.messages(topics, since, until)

    def first_static_transforms(self) -> List[Any]:
        """Of each frame the first on /tf_static, wherever it is."""
        every = [transform for bag in self._bags for transform in bag.first_static_transforms()]
        return list({transform.child_frame_id: transform for transform in reversed(every)}.values())


def bag_paths(paths: Sequence[Path]) -> List[Path]:
    """The bags that are named: files, or folders of bags, also the folder of a run. Raises BagError."""
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
