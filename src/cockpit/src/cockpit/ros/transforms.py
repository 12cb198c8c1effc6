"""/tf and /tf_static into a tree of frames."""

from collections import Counter
from typing import Iterator, List

from cockpit.errors import CockpitError
from cockpit.frames import FrameTree, Transform, pose_from_message
from cockpit.ros.graph import TopicFeed

TOPICS = ("/tf", "/tf_static")
KIND = "tf2_msgs/TFMessage"


class TransformFeed:
    """Keeps ``frames`` up to date while it listens; ``counts``: how many transforms of each have come."""

    def __init__(self, frames: FrameTree):
        self._frames = frames
        self.counts: Counter = Counter()
        self._feeds: List[TopicFeed] = []

    def listen(self, wanted: bool) -> None:
        if wanted and not self._feeds:
            self._feeds = [TopicFeed(topic, KIND, all_of_them=True) for topic in TOPICS]
        if not wanted:
            for feed in self._feeds:
                feed.close()
            self._feeds = []

    def update(self) -> None:
        """Takes in what has come. Raises CockpitError if some of it makes no sense, after all the rest."""
        troubles = [trouble for feed in self._feeds for trouble in self._update_from(feed)]
        if troubles:
            raise CockpitError(troubles[0])

    def _update_from(self, feed: TopicFeed) -> Iterator[str]:
        """What is wrong with what has come."""
        try:
            for _, message, sender in feed.stamped_messages():
                for stamped in message.transforms:
                    if not self._take(stamped, feed.topic == TOPICS[1], sender):
                        yield f"{sender} sends a transform of {stamped.child_frame_id} that is none"
        except CockpitError as error:
            yield str(error)

    def _take(self, stamped, is_static: bool, sender: str) -> bool:
        """Whether it is a transform."""
        pose = pose_from_message(stamped.transform.translation, stamped.transform.rotation)
        if pose is None:
            return False
        parent, stamp = stamped.header.frame_id.lstrip("/"), stamped.header.stamp.to_sec()
        self.counts[stamped.child_frame_id.lstrip("/")] += 1
        self._frames.put(stamped.child_frame_id, Transform(parent, pose, stamp, is_static, sender))
        return True
