"""Topics that an rviz configuration displays."""

from typing import Iterator, Set

import yaml

from planar.config.bounded_yaml import load_yaml

# Not subscribed: images and point clouds, because rendering them is expensive, and markers, because the
# observer must be their first subscriber: some nodes publish a marker once, as soon as they have one.
EXCLUDED_DISPLAYS = (
    "Image",
    "Camera",
    "DepthCloud",
    "PointCloud2",
    "PointCloud",
    "RGBDImage",
    "Marker",
    "MarkerArray",
)
TOPIC_KEYS = ("Topic", "Marker Topic", "Update Topic")


def displayed_topics(text: str) -> Set[str]:
    """Topics of all enabled displays in a configuration, without EXCLUDED_DISPLAYS.

    Args:
        text: Contents of an ``.rviz`` file; an invalid one has no topics.
    """
    try:
        config = load_yaml(text.replace("\t", "  "))
    except (yaml.YAMLError, ValueError):
        return set()
    manager = config.get("Visualization Manager") if isinstance(config, dict) else None
    displays = manager.get("Displays") if isinstance(manager, dict) else None
    return set(_topics(displays))


def _topics(displays) -> Iterator[str]:
    for display in displays if isinstance(displays, list) else ():
        if not isinstance(display, dict) or not display.get("Enabled", True):
            continue
        yield from _topics(display.get("Displays"))
        if str(display.get("Class", "")).rsplit("/", 1)[-1] in EXCLUDED_DISPLAYS:
            continue
        for key in TOPIC_KEYS:
            topic = display.get(key)
            if isinstance(topic, str) and topic:
                yield topic if topic.startswith("/") else f"/{topic}"
