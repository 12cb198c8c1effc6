"""Reader of ROS 1 bags, including truncated and partly broken ones."""

import math
import shutil
import tempfile
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, NamedTuple, Optional, Tuple, Union

import rosbag
import rospy
from roslib.message import get_message_class

from planar import PlanarError

TF, TF_STATIC = "/tf", "/tf_static"
LASER_SCAN = "sensor_msgs/LaserScan"
# Message type of transforms, and its name before ROS Hydro.
TF_MESSAGE, OLD_TF_MESSAGE = "tf2_msgs/TFMessage", "tf/tfMessage"
# Margin [s] around time bounds, because a float does not hold a time to the nanosecond.
TIME_MARGIN = 1e-6


class BagError(PlanarError):
    """A bag is unreadable, entirely or from some point on; the text names the bag and the position."""


class RecordedMessage(NamedTuple):
    """A message of a bag.

    Attributes:
        topic: Absolute topic name.
        message: The deserialized message.
        stamp: Time at which it was recorded [s].
    """

    topic: str
    message: Any
    stamp: float


class BagReader:
    """Read-only view of a bag; a truncated bag is read up to its last complete chunk.

    Topic names are absolute ("/scan"), even if they were recorded without the slash. Messages are in the
    order of the time at which they were recorded, also if the chunks of the file are not, as after merging
    bags.

    Args:
        path: The bag file; it is never modified.

    Attributes:
        types: Message type of each topic; tf/tfMessage, which is the same message, as tf2_msgs/TFMessage.
        unavailable_topics: Topics whose message type is not installed or differs from the recorded one.
        is_empty: Whether the bag has no messages.
        start: Time of the first message [s]; 0 for an empty bag.
        end: Time of the last message [s]; 0 for an empty bag.
        truncation: Where the file was cut off, for messages to people; None for a complete bag.

    Raises:
        BagError: If the file is not a readable bag.
    """

    def __init__(self, path: Union[str, Path]):
        self.path = Path(path)
        self._bag, is_cut_off = _open(self.path)
        try:
            self._read_index()
        except Exception as error:  # rosbag passes on whatever struct, bz2 and genpy raise
            raise BagError(f"{path}: not a readable bag ({error or type(error).__name__})") from None
        self.truncation: Optional[str] = None
        if is_cut_off:
            self.truncation = f"cut off {self.end - self.start:.1f} s after its start"

    def _read_index(self) -> None:
        sums, topics = self._bag.get_type_and_topic_info()
        recorded = {absolute_name(topic): info.msg_type for topic, info in topics.items()}
        self.types: Dict[str, str] = {
            topic: TF_MESSAGE if kind == OLD_TF_MESSAGE else kind for topic, kind in recorded.items()
        }
        self.unavailable_topics = {
            topic for topic, kind in recorded.items() if not _is_installed(self.types[topic], sums[kind])
        }
        self._spellings = {topic: absolute_name(topic) for topic in topics}
        self.is_empty = self._bag.get_message_count() == 0
        self.start, self.end = (0.0, 0.0) if self.is_empty else _sorted_index(self._bag)

    def messages(
        self, topics: Iterable[str], since: float = 0.0, until: float = math.inf
    ) -> Iterator[RecordedMessage]:
        """Iterate over the messages of some topics in recorded order.

        Args:
            topics: Topic names, with or without the leading slash.
            since: Start of the time interval [s], inclusive.
            until: End of the time interval [s], inclusive.

        Yields:
            The messages recorded within the interval.

        Raises:
            BagError: Where the bag is broken.
        """
        wanted = set(map(absolute_name, topics))
        spelled = [spelling for spelling, topic in self._spellings.items() if topic in wanted]
        if not spelled or since > self.end or until < self.start:  # rosbag reads an empty list as all topics
            return
        first = rospy.Time.from_sec(max(since - TIME_MARGIN, 0.0))
        last = None if until >= self.end else rospy.Time.from_sec(until + TIME_MARGIN)
        reader, now = self._bag.read_messages(spelled, first, last), self.start
        while True:
            try:
                topic, message, recorded = next(reader)
            except StopIteration:
                return
            except Exception as error:  # rosbag passes on whatever struct, bz2 and genpy raise
                after = f"broken {now - self.start:.1f} s after its start"
                raise BagError(f"{self.path}: {after} ({error or type(error).__name__})") from None
            now = recorded.to_sec()
            yield RecordedMessage(self._spellings[topic], message, now)


def absolute_name(topic: str) -> str:
    """Return a topic name with exactly one leading slash."""
    return "/" + topic.lstrip("/")


def _sorted_index(bag: rosbag.Bag) -> Tuple[float, float]:
    """Sort the index of a bag by time, as ``rosbag play`` does, and return the first and the last time [s].

    rosbag for Python merges the messages of the topics in the order of the file's chunks, and takes the times
    of the first and last chunk for those of the bag. It has no public access to its index.
    """
    indexes = list(bag._connection_indexes.values())
    for index in indexes:
        index.sort(key=lambda entry: entry.time.to_nsec())  # stable, and fast if it is in order
    return min(each[0].time for each in indexes).to_sec(), max(each[-1].time for each in indexes).to_sec()


def _is_installed(kind: str, md5sum: str) -> bool:
    found = get_message_class(kind)
    return found is not None and found._md5sum == md5sum


def _open(path: Path) -> Tuple[rosbag.Bag, bool]:
    """Return the open bag and whether it is truncated."""
    try:
        if path.exists() and not path.is_file():
            raise BagError(f"{path}: not a readable bag (not a regular file)")
        return rosbag.Bag(str(path)), False
    except BagError:
        raise
    except rosbag.ROSBagUnindexedException:
        return _open_truncated(path), True
    except Exception as error:  # rosbag passes on whatever struct, bz2 and genpy raise
        raise BagError(f"{path}: not a readable bag ({error or type(error).__name__})") from None


def _open_truncated(path: Path) -> rosbag.Bag:
    """Open the complete chunks of a truncated bag, from a copy, because rosbag reindexes in place."""
    try:
        with tempfile.TemporaryDirectory() as folder:
            copy = str(Path(folder) / "copy.bag")
            shutil.copyfile(path, copy)
            with rosbag.Bag(copy, "a", allow_unindexed=True) as broken:
                for _ in broken.reindex():
                    pass
            bag = rosbag.Bag(copy)  # stays open after the folder is removed
        count = bag.get_message_count()
    except Exception as error:  # rosbag passes on whatever struct, bz2 and genpy raise
        raise BagError(f"{path}: not a readable bag ({error or type(error).__name__})") from None
    if count == 0:
        raise BagError(f"{path}: cut off before the first complete chunk of messages")
    return bag
