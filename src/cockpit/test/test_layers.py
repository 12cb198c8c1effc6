"""From messages to drawings."""

import math

import numpy as np
import pytest
from geometry_msgs.msg import Point, Pose, PoseArray, PoseStamped
from nav_msgs.msg import OccupancyGrid, Path
from sensor_msgs.msg import Image, LaserScan
from visualization_msgs.msg import Marker, MarkerArray

from cockpit.drawing import FloorImage, Label, LineSegments, PointCloudShape, TriangleMesh
from cockpit.errors import CockpitError
from cockpit.layers import all_layers, by_type
from cockpit.layers.maps import MAP_COLOURS


def drawn(message, kind):
    return by_type()[kind].make()(message)


def marker(**fields):
    found = Marker(ns="a", id=1, type=Marker.CUBE)
    found.header.frame_id = "map"
    found.pose.orientation.w = 1.0
    found.scale.x = found.scale.y = found.scale.z = 2.0
    for name, value in fields.items():
        setattr(found, name, value)
    return found


def markers(*several):
    return drawn(MarkerArray(markers=list(several)), "visualization_msgs/MarkerArray")


def test_every_type_of_message_has_one_layer():
    kinds = [kind for layer in all_layers() for kind in layer.types]
    assert len(kinds) == len(set(kinds)) >= 10


def test_a_scan_is_the_points_that_were_seen():
    scan = LaserScan(angle_min=0.0, angle_increment=math.pi / 2, range_min=0.1, range_max=5.0)
    scan.header.frame_id = "laser"
    scan.ranges = [1.0, 2.0, float("inf"), float("nan"), 0.0, 9.0]
    (part,) = drawn(scan, "sensor_msgs/LaserScan").parts
    assert part.frame == "laser"
    assert isinstance(part.shape, PointCloudShape)
    assert np.allclose(part.shape.points, [(1.0, 0.0, 0.0), (0.0, 2.0, 0.0)])


def test_a_scan_at_angles_that_are_none_is_no_points():
    scan = LaserScan(angle_min=math.nan, angle_increment=math.inf, range_max=5.0, ranges=[1.0, 2.0])
    (part,) = drawn(scan, "sensor_msgs/LaserScan").parts
    assert part.shape.points.shape == (0, 3)


def grid(data, width=2, height=2):
    message = OccupancyGrid(data=data)
    message.info.width, message.info.height, message.info.resolution = width, height, 0.5
    message.info.origin.orientation.w = 1.0
    return message


def test_a_map_is_a_picture_whose_first_row_is_the_last_of_the_grid():
    (part,) = drawn(grid([0, 100, -1, 0]), "nav_msgs/OccupancyGrid").parts
    assert isinstance(part.shape, FloorImage)
    assert (part.shape.picture[0, 0] == MAP_COLOURS[255]).all()
    assert (part.shape.picture[1, 1] == MAP_COLOURS[100]).all()
    assert (part.shape.width, part.shape.height) == (1.0, 1.0)


def test_a_grid_of_the_wrong_size_is_refused_in_a_sentence():
    with pytest.raises(CockpitError, match="a grid of 2 x 2 with 3 cells"):
        drawn(grid([0, 0, 0]), "nav_msgs/OccupancyGrid")


def test_a_path_leaves_out_what_is_not_finite():
    path = Path(poses=[PoseStamped() for _ in range(4)])
    for number, pose in enumerate(path.poses):
        pose.pose.position.x = float("nan") if number == 1 else float(number)
    (part,) = drawn(path, "nav_msgs/Path").parts
    assert part.shape.segments[:, :, 0].tolist() == [[0.0, 2.0], [2.0, 3.0]]


def test_an_empty_path_and_no_particles_are_drawings_of_nothing():
    assert len(drawn(Path(), "nav_msgs/Path").parts[0].shape.segments) == 0
    assert len(drawn(PoseArray(), "geometry_msgs/PoseArray").parts[0].shape.segments) == 0


def test_particles_are_lines_along_where_they_look():
    pose = Pose()
    pose.orientation.z = pose.orientation.w = math.sqrt(0.5)
    (part,) = drawn(PoseArray(poses=[pose]), "geometry_msgs/PoseArray").parts
    along = part.shape.segments[0, 1] - part.shape.segments[0, 0]
    assert np.allclose(along, [0.0, 0.12, 0.0])


@pytest.mark.parametrize(
    ("kind", "shape"),
    [
        (Marker.ARROW, LineSegments),
        (Marker.CUBE, TriangleMesh),
        (Marker.SPHERE, TriangleMesh),
        (Marker.CYLINDER, TriangleMesh),
        (Marker.LINE_STRIP, LineSegments),
        (Marker.LINE_LIST, LineSegments),
        (Marker.CUBE_LIST, TriangleMesh),
        (Marker.SPHERE_LIST, TriangleMesh),
        (Marker.POINTS, PointCloudShape),
        (Marker.TEXT_VIEW_FACING, Label),
        (Marker.TRIANGLE_LIST, TriangleMesh),
    ],
)
@pytest.mark.parametrize("count", [0, 3])
def test_each_type_of_marker_is_drawn_whatever_its_points(kind, shape, count):
    drawing = markers(marker(type=kind, points=[Point(float(i), 0.0, 0.0) for i in range(count)]))
    assert not drawing.warning
    assert isinstance(drawing.parts[0].shape, shape)


def test_a_cube_is_as_large_as_its_scale():
    (part,) = markers(marker()).parts
    assert part.shape.vertices.max() == 1.0
    assert part.seconds == math.inf


def test_a_nan_in_a_marker_is_reported_and_the_others_are_drawn():
    drawing = markers(marker(id=1, points=[Point(float("nan"), 0.0, 0.0)]), marker(id=2))
    assert "marker a:1" in drawing.warning
    assert [part.name for part in drawing.parts] == ["a:2"]


def test_markers_are_deleted_one_by_one_or_all():
    assert markers(marker(action=Marker.DELETE)).gone == ("a:1",)
    everything = markers(marker(id=7), marker(action=Marker.DELETEALL), marker(id=9))
    assert everything.gone == ("*",)
    assert [part.name for part in everything.parts] == ["a:9"]


def test_a_picture_is_shown_in_the_order_of_its_colours():
    image = Image(width=1, height=1, encoding="bgr8", step=3, data=bytes([1, 2, 3]))
    (part,) = drawn(image, "sensor_msgs/Image").parts
    assert part.shape.picture.tolist() == [[[3, 2, 1]]]


def test_a_picture_that_is_cut_off_is_refused():
    with pytest.raises(CockpitError, match="a picture of 2 bytes"):
        drawn(Image(width=1, height=1, encoding="rgb8", step=3, data=b"ab"), "sensor_msgs/Image")
