"""Markers are not hidden by the robot, maps or costmaps."""

from unittest.mock import Mock

import pytest

from add_markers import CarriedParcel, MarkerSettings
from add_markers.boxes import RIDING_HEIGHT
from add_markers.parcel import ParcelStage
from add_markers.ros.node import AddMarkersNode
from add_markers.ros.zones import zone_markers
from planar import Pose2
from planar.maps.places import NamedPlace

PICKUP, DROPOFF = NamedPlace("pickup", Pose2(1.0, 2.0)), NamedPlace("dropoff", Pose2(3.0, 4.0))
SIZE = 0.2
# Height at which the cockpit draws costmaps [m].
COSTMAP_HEIGHT = 0.02


@pytest.mark.parametrize(
    ("stage", "place", "lowest"),
    [(ParcelStage.WAITING, PICKUP, 0.0), (ParcelStage.DELIVERED, DROPOFF, RIDING_HEIGHT)],
)
def test_the_object_waits_on_the_floor_and_is_on_the_robot_once_delivered(stage, place, lowest):
    node = object.__new__(AddMarkersNode)
    node._settings, node._pickup, node._publisher, node._shown_at = (
        MarkerSettings("z", size=SIZE),
        PICKUP,
        Mock(),
        0,
    )
    node._parcel = CarriedParcel(PICKUP, DROPOFF, 5.0, stage)
    node._show(node._parcel.update(0.0, None))
    ((marker,), _) = node._publisher.publish.call_args
    position = marker.pose.position
    assert (position.x, position.y) == (place.pose.x, place.pose.y)
    assert position.z - SIZE / 2.0 == pytest.approx(lowest)


def test_zones_are_drawn_above_maps_and_costmaps():
    markers = zone_markers([PICKUP, DROPOFF], "map").markers
    assert len(markers) == 6
    for marker in markers:
        heights = [point.z for point in marker.points] or [marker.pose.position.z]
        assert min(heights) > COSTMAP_HEIGHT
