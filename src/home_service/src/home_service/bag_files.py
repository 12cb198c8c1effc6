"""The bags of a recording, in the order of time."""

from pathlib import Path
from typing import Any, Iterator, List, NamedTuple, Sequence, Set, Tuple

from planar_ros.bags.scan_log import BagError, open_bag

LASER_SCAN = "sensor_msgs/LaserScan"
INPUT_TYPES = {LASER_SCAN, "sensor_msgs/PointCloud2", "nav_msgs/Odometry", "tf2_msgs/TFMessage"}


class Played(NamedTuple):
    """A message as it was recorded; ``stamp`` is when, in seconds."""

    topic: str
    message: Any
    stamp: float


class Recording:
    """Bags that follow each other, opened for reading alone: broken ones are read as far as they go.

    ``gaps`` says which ends are missing. Raises BagError.
    """

    def __init__(self, paths: Sequence[Path]):
        self.paths = bag_paths(paths)
        self.gaps: List[str] = []
        self._bags = []
        for path in self.paths:
            bag, is_cut_off = open_bag(path)
            if is_cut_off:
                seconds = bag.get_end_time() - bag.get_start_time()
                self.gaps.append(f"{path.name}: cut off {seconds:.1f} s after its start")
            self._bags.append(bag)
        if not any(bag.get_message_count() for bag in self._bags):
            raise BagError(f"{self.paths[0]}: there is no message in it")
        self._bags = sorted(
            (bag for bag in self._bags if bag.get_message_count()), key=lambda bag: bag.get_start_time()
        )
        self.start, self.end = self._bags[0].get_start_time(), self._bags[-1].get_end_time()

    @property
    def types(self) -> dict:
        """The type of each topic."""
        return {
            topic: info.msg_type
            for bag in self._bags
            for topic, info in bag.get_type_and_topic_info().topics.items()
        }

    def topics_of(self, *types: str) -> List[str]:
        return sorted(topic for topic, kind in self.types.items() if kind in types)

    def messages(self, topics: Set[str]) -> Iterator[Played]:
        """The messages of ``topics`` in the order in which they were recorded. Raises BagError."""
        for path, bag in zip(self.paths, self._bags):
            reader = bag.read_messages(list(topics))
            while True:
                try:
                    topic, message, stamp = next(reader)
                except StopIteration:
                    break
                except Exception as error:  # rosbag lets pass whatever struct, bz2 and genpy raise
                    raise BagError(f"{path}: broken ({error or type(error).__name__})") from None
                yield Played(topic, message, stamp.to_sec())


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
