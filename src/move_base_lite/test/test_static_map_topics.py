"""Maps of static layers from their topics: the first map only, updates, and other frames."""

from types import SimpleNamespace

import numpy as np
import pytest

from move_base_lite.costmap import StaticMapSource
from move_base_lite.ros.sensing import static_maps
from planar import Pose2
from planar_ros.messages.validation import MessageError


class Topics:
    """Delivers messages to the subscribers of a topic."""

    def __init__(self, monkeypatch):
        self._handlers = {}
        monkeypatch.setattr(static_maps, "subscribe", self._subscribe)

    def _subscribe(self, topic, kind, handle, **how):
        self._handlers.setdefault(topic, []).append(handle)
        return topic

    def publish(self, topic, message):
        for handle in self._handlers.get(topic, []):
            handle(message)


@pytest.fixture
def topics(monkeypatch):
    return Topics(monkeypatch)


def map_message(value, frame="map"):
    orientation = SimpleNamespace(x=0.0, y=0.0, z=0.0, w=1.0)
    origin = SimpleNamespace(position=SimpleNamespace(x=0.0, y=0.0, z=0.0), orientation=orientation)
    info = SimpleNamespace(width=3, height=2, resolution=0.5, origin=origin)
    return SimpleNamespace(header=SimpleNamespace(frame_id=frame), info=info, data=[value] * 6)


def update(x, y, width, height, value):
    return SimpleNamespace(x=x, y=y, width=width, height=height, data=[value] * (width * height))


def subscribed(*sources, transforms=None):
    return static_maps.StaticMapTopics(sources, ["map", "odom"], transforms)


def test_each_source_has_the_latest_map_of_its_topic(topics):
    real, virtual = StaticMapSource("map"), StaticMapSource("walls")
    maps = subscribed(real, virtual)
    topics.publish("map", map_message(0))
    topics.publish("map", map_message(100))
    assert (maps.has_map(real), maps.has_map(virtual)) == (True, False)
    taken = maps.take_new()
    assert [*taken] == [real]
    assert (taken[real].grid.cells == 100).all()
    assert maps.take_new() == {}


def test_with_first_map_only_later_maps_are_ignored(topics):
    first, latest = StaticMapSource("map", first_map_only=True), StaticMapSource("map")
    maps = subscribed(first, latest)
    topics.publish("map", map_message(0))
    topics.publish("map", map_message(100))
    taken = maps.take_new()
    assert [int(taken[source].grid.cells[0, 0]) for source in (first, latest)] == [0, 100]


def test_updates_change_a_block_of_the_map_of_those_that_subscribe(topics):
    with_updates, without = StaticMapSource("map", with_updates=True), StaticMapSource("map")
    maps = subscribed(with_updates, without)
    topics.publish("map_updates", update(0, 0, 1, 1, 100))  # before the map: nothing to change
    topics.publish("map", map_message(0))
    topics.publish("map_updates", update(1, 0, 2, 1, 100))
    taken = maps.take_new()
    np.testing.assert_array_equal(taken[with_updates].grid.cells, [[0, 100, 100], [0, 0, 0]])
    assert not taken[without].grid.cells.any()


@pytest.mark.parametrize("block", [update(2, 0, 2, 1, 0), update(-1, 0, 1, 1, 0), update(0, 1, 1, 2, 0)])
def test_an_update_outside_the_map_is_refused(topics, block):
    maps = subscribed(StaticMapSource("map", with_updates=True))
    topics.publish("map", map_message(0))
    with pytest.raises(MessageError, match="an update must lie within the map of 3 x 2 cells"):
        topics.publish("map_updates", block)
    assert len(maps.take_new()) == 1


def test_a_map_in_another_frame_waits_for_its_transform_and_is_moved(topics, monkeypatch):
    monkeypatch.setattr(static_maps.rospy, "logwarn_throttle", lambda *text: None)
    poses = {}
    source = StaticMapSource("walls")
    lookup = SimpleNamespace(lookup=lambda target, frame: poses.get((target, frame)))
    maps = subscribed(source, transforms=lookup)
    topics.publish("walls", map_message(100, "building"))
    assert maps.take_new() == {}
    poses["map", "building"] = Pose2(2.0, 1.0)
    taken = maps.take_new()[source]
    assert (taken.frame, taken.grid.origin) == ("map", Pose2(2.0, 1.0))
