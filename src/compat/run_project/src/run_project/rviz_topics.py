"""Which topics an rviz configuration displays."""

from typing import Iterator, Set

import yaml

# rviz listens to this one in every marker display that names no other.
ALWAYS = "/visualization_marker"
# Pictures and clouds: heavy to make, and nobody looks at them without a window.
UNSEEN = ("Image", "Camera", "DepthCloud", "PointCloud2", "PointCloud", "RGBDImage")
TOPIC_KEYS = ("Topic", "Marker Topic", "Update Topic")


def topics_of(text: str) -> Set[str]:
    """The topics of all enabled displays in the text of a configuration, and ALWAYS."""
    try:
        config = yaml.safe_load(text.replace("\t", "  "))
    except yaml.YAMLError:
        return {ALWAYS}
    manager = config.get("Visualization Manager") if isinstance(config, dict) else None
    displays = manager.get("Displays") if isinstance(manager, dict) else None
    return {ALWAYS, *_topics(displays)}


def _topics(displays) -> Iterator[str]:
    for display in displays if isinstance(displays, list) else ():
        if not isinstance(display, dict) or not display.get("Enabled", True):
            continue
        yield from _topics(display.get("Displays"))
        if str(display.get("Class", "")).rsplit("/", 1)[-1] in UNSEEN:
            continue
        for key in TOPIC_KEYS:
            topic = display.get(key)
            if isinstance(topic, str) and topic:
                yield topic if topic.startswith("/") else f"/{topic}"
