"""State of a recording at some time: the messages that a subscriber from its start holds by then."""

import math
from typing import Dict, Iterable, List

from planar_ros.bags.bag_reader import TF, RecordedMessage
from planar_ros.bags.recording import Recording

MARKERS = ("visualization_msgs/Marker", "visualization_msgs/MarkerArray")
# Intervals before the requested time [s], searched in turn; most topics and moving frames are in the first.
SEARCH_SECONDS = (2.0, 20.0, math.inf)


def snapshot_at(recording: Recording, topics: Iterable[str], stamp: float) -> List[RecordedMessage]:
    """Return the messages needed to show a recording at some time.

    Args:
        recording: The recording.
        topics: Topic names.
        stamp: Recorded time [s], inclusive.

    Returns:
        The newest message of each topic, the transforms of the last seconds and all markers, in recorded
        order.

    Raises:
        BagError: Where a bag is broken.
    """
    types = recording.types
    cumulative = {topic for topic in topics if topic == TF or types.get(topic) in MARKERS}
    found = list(_newest(recording, set(topics) - cumulative, stamp).values())
    found += recording.messages(cumulative & {TF}, stamp - SEARCH_SECONDS[0], stamp)
    found += recording.messages(cumulative - {TF}, until=stamp)
    return sorted(found, key=lambda each: each.stamp)


def _newest(recording: Recording, topics: Iterable[str], stamp: float) -> Dict[str, RecordedMessage]:
    missing, until = set(topics), stamp
    found: Dict[str, RecordedMessage] = {}
    for seconds in SEARCH_SECONDS:
        if not missing:
            break
        since = stamp - seconds
        found.update({each.topic: each for each in recording.messages(missing, since, until)})
        missing -= set(found)
        until = since
    return found
