"""Subscriptions of /tf and /tf_static that fill a tree of frames."""

from collections import Counter
from typing import Iterator, List

from cockpit.errors import CockpitError
from cockpit.frames import FrameTree, Transform, pose_from_message
from cockpit.ros.graph import TopicFeed

TOPICS = ("/tf", "/tf_static")
KIND = "tf2_msgs/TFMessage"


class TransformFeed:
    """Fills a tree of frames while it is subscribed to /tf and /tf_static.

    Args:
        frames: The tree.

    Attributes:
        counts: Transforms received so far, by child frame.
    """

    def __init__(self, frames: FrameTree):
        self._frames = frames
        self.counts: Counter = Counter()
        self._feeds: List[TopicFeed] = []

    def subscribe(self, wanted: bool) -> None:
        if wanted and not self._feeds:
            self._feeds = [TopicFeed(topic, KIND, all_of_them=True) for topic in TOPICS]
        if not wanted:
            for feed in self._feeds:
                feed.close()
            self._feeds = []

    def update(self) -> None:
        """Store the new transforms.

        Raises:
            CockpitError: One of them was malformed; the others are stored.
        """
        errors = [error for feed in self._feeds for error in self._update_from(feed)]
        if errors:
            raise CockpitError(errors[0])

    def _update_from(self, feed: TopicFeed) -> Iterator[str]:
        """Store the new messages of a topic and yield what is wrong with them."""
        try:
            for _, message, sender in feed.stamped_messages():
                for stamped in message.transforms:
                    if not self._store(stamped, feed.topic == TOPICS[1], sender):
                        name = stamped.child_frame_id
                        yield f"{sender} publishes an invalid transform of {name} (not finite)"
        except CockpitError as error:
            yield str(error)

    def _store(self, stamped, is_static: bool, sender: str) -> bool:
        """Store a transform and return whether it is valid."""
        pose = pose_from_message(stamped.transform.translation, stamped.transform.rotation)
        if pose is None:
            return False
        parent, stamp = stamped.header.frame_id.lstrip("/"), stamped.header.stamp.to_sec()
        self.counts[stamped.child_frame_id.lstrip("/")] += 1
        self._frames.put(stamped.child_frame_id, Transform(parent, pose, stamp, is_static, sender))
        return True
