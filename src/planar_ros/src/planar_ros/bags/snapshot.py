"""What stands at a moment of a recording: what one who has listened from its start holds by then."""

import math
from typing import Dict, Iterable, List

from planar_ros.bags.bag_reader import TF, RecordedMessage
from planar_ros.bags.recording import Recording

MARKERS = ("visualization_msgs/Marker", "visualization_msgs/MarkerArray")
# Most topics are found in the first of these stretches back, s; so are transforms of frames that move.
STRETCHES = (2.0, 20.0, math.inf)


def snapshot_at(recording: Recording, topics: Iterable[str], moment: float) -> List[RecordedMessage]:
    """The newest message of each topic, of transforms those of the last seconds, of markers all, in order.

    ``moment``: s, itself included. Raises BagError.
    """
    types = recording.types
    adding = {topic for topic in topics if topic == TF or types.get(topic) in MARKERS}
    played = list(_newest(recording, set(topics) - adding, moment).values())
    played += recording.messages(adding & {TF}, moment - STRETCHES[0], moment)
    played += recording.messages(adding - {TF}, until=moment)
    return sorted(played, key=lambda each: each.stamp)


def _newest(recording: Recording, topics: Iterable[str], moment: float) -> Dict[str, RecordedMessage]:
    missing, until = set(topics), moment
    found: Dict[str, RecordedMessage] = {}
    for stretch in STRETCHES:
        if not missing:
            break
        since = moment - stretch
        found.update({each.topic: each for each in recording.messages(missing, since, until)})
        missing -= set(found)
        until = since
    return found
