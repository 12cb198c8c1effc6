"""A bag: what is in it, its messages in order, and how far it can be read."""

import contextlib
import math
import shutil
import tempfile
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, NamedTuple, Optional, Tuple, Union

import rosbag
import rospy
from roslib.message import get_message_class

from planar import PlanarError

TF, TF_STATIC = "/tf", "/tf_static"
LASER_SCAN = "sensor_msgs/LaserScan"
TICK = 1e-6


class BagError(PlanarError):
    """A bag cannot be read, or not to its end; the text names it and says where it broke."""


class RecordedMessage(NamedTuple):
    """A message as it was recorded; ``stamp`` is when, in seconds."""

    topic: str
    message: Any
    stamp: float


class BagReader:
    """A bag opened for reading alone; one that was cut off is read as far as it goes.

    Topics have their full names, "/scan", also where they were recorded without the slash. ``types``: that of
    each. ``foreign``: topics whose types are not installed, or otherwise than they were recorded. ``start``,
    ``end``: seconds, 0 if it is empty. ``gap``: what is missing at its end, if anything is. Raises BagError.
    """

    def __init__(self, path: Union[str, Path]):
        self.path = Path(path)
        self._bag, is_cut_off = _open(self.path)
        try:
            self._look_over()
        except Exception as error:  # as below
            raise BagError(f"{path}: not a readable bag ({error or type(error).__name__})") from None
        self.truncation: Optional[str] = None
        if is_cut_off:
            self.truncation = f"cut off {self.end - self.start:.1f} s after its start"

    def _look_over(self) -> None:
        sums, topics = self._bag.get_type_and_topic_info()
        self.types: Dict[str, str] = {absolute_name(topic): info.msg_type for topic, info in topics.items()}
        self.unavailable_topics = {
            topic for topic, kind in self.types.items() if not _is_installed(kind, sums[kind])
        }
        self._spellings = {topic: absolute_name(topic) for topic in topics}
        self.is_empty = self._bag.get_message_count() == 0
        self.start = 0.0 if self.is_empty else self._bag.get_start_time()
        self.end = 0.0 if self.is_empty else self._bag.get_end_time()

    def messages(
        self, topics: Iterable[str], since: float = 0.0, until: float = math.inf
    ) -> Iterator[RecordedMessage]:
        """The messages of ``topics`` in the order in which they were recorded, and when. Raises BagError.

        ``since``, ``until``: those that were recorded between, both included, s.
        """
        wanted = set(map(absolute_name, topics))
        spelled = [spelling for spelling, topic in self._spellings.items() if topic in wanted]
        if not spelled or since > self.end or until < self.start:  # of no topics rosbag would make all
            return
        # To the nanosecond a time is no float: what lies on a bound is taken rather twice than not at all.
        first = rospy.Time.from_sec(max(since - TICK, 0.0))
        last = None if until >= self.end else rospy.Time.from_sec(until + TICK)
        reader, now = self._bag.read_messages(spelled, first, last), self.start
        while True:
            try:
                topic, message, recorded = next(reader)
            except StopIteration:
                return
            except Exception as error:  # rosbag lets pass whatever struct, bz2 and genpy raise
                after = f"broken {now - self.start:.1f} s after its start"
                raise BagError(f"{self.path}: {after} ({error or type(error).__name__})") from None
            now = recorded.to_sec()
            yield RecordedMessage(self._spellings[topic], message, now)

    def first_static_transforms(self) -> List[Any]:
        """Of each frame the first on /tf_static, wherever in the bag it is.

        They hold from the start: a recorder that joins late, or repeats them at a split, writes them late.
        """
        found: Dict[str, Any] = {}
        with contextlib.suppress(BagError):  # told by whoever reads on to where it is broken
            for played in self.messages([TF_STATIC]):
                for transform in played.message.transforms:
                    found.setdefault(transform.child_frame_id, transform)
        return list(found.values())


def absolute_name(topic: str) -> str:
    return "/" + topic.lstrip("/")


def _is_installed(kind: str, md5sum: str) -> bool:
    found = get_message_class(kind)
    return found is not None and found._md5sum == md5sum


def _open(path: Path) -> Tuple[rosbag.Bag, bool]:
    """The bag, and whether its end is missing."""
    try:
        if path.exists() and not path.is_file():
            raise BagError(f"{path}: not a readable bag (not a regular file)")
        return rosbag.Bag(str(path)), False
    except BagError:
        raise
    except rosbag.ROSBagUnindexedException:
        return _without_end(path), True
    except Exception as error:  # rosbag lets pass whatever struct, bz2 and genpy raise
        raise BagError(f"{path}: not a readable bag ({error or type(error).__name__})") from None


def _without_end(path: Path) -> rosbag.Bag:
    """The complete part of a bag, from a copy: rosbag repairs the file itself."""
    try:
        with tempfile.TemporaryDirectory() as folder:
            copy = str(Path(folder) / "copy.bag")
            shutil.copyfile(path, copy)
            with rosbag.Bag(copy, "a", allow_unindexed=True) as broken:
                for _ in broken.reindex():
                    pass
            bag = rosbag.Bag(copy)  # which stays open when the folder has gone
        count = bag.get_message_count()
    except Exception as error:  # rosbag lets pass whatever struct, bz2 and genpy raise
        raise BagError(f"{path}: not a readable bag ({error or type(error).__name__})") from None
    if count == 0:
        raise BagError(f"{path}: cut off before the first complete chunk of messages")
    return bag
