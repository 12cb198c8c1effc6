"""The simulated detector: range, field of view, walls, shelves, missed detections."""

import numpy as np
import pytest

from planar import Pose2
from planar.detection import DetectionModel
from planar.maps.semantic_map import PlacedObject
from sim_bridge import ROBOTS, Simulation
from sim_bridge.geometry.shapes import Plane
from sim_bridge.sensors.object_detector import with_object_detector
from sim_bridge.simulation import box_on_floor
from sim_bridge.world import Body, Collision, World

FLOOR = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
ROBOT, MODEL = ROBOTS["turtlebot_lidar"], DetectionModel()
IMAGES = 60


def images(item, *bodies, seed=0):
    """Return what the robot at the origin, facing along x, detects in each image."""
    simulation = Simulation(World("room", (FLOOR, *bodies)), with_object_detector(ROBOT, [item]), seed=seed)
    found = []
    while len(found) < IMAGES:
        reading = simulation.step().readings.get("object_detector")
        if reading is not None:
            found.append(reading.value)
    simulation.close()
    return found


def cup(x, y, z=0.8):
    return PlacedObject("cup", x, y, z)


def share(found):
    return sum(map(bool, found)) / len(found)


def test_an_object_in_view_is_detected_as_often_as_the_model_states_and_where_it_is():
    found = images(cup(1.5, 0.3))
    assert abs(share(found) - MODEL.probability) < 0.12  # 3 standard deviations of 60 images
    points = np.array([(each[0].x, each[0].y) for each in found if each])
    assert np.abs(points.mean(axis=0) - (1.5, 0.3)).max() < 0.02
    assert 0.015 < points.std(axis=0).max() < 0.05


def test_detections_become_rarer_with_distance():
    assert 0.25 < share(images(cup(3.0, 0.0))) < 0.65
    assert share(images(cup(4.2, 0.0))) == 0.0


@pytest.mark.parametrize("where", [(-1.5, 0.0), (0.0, 1.5), (1.0, 1.0), (0.2, 0.0)])
def test_what_is_beside_behind_or_too_near_is_not_detected(where):
    assert share(images(cup(*where))) == 0.0


def test_a_wall_hides_and_a_low_table_does_not():
    wall = box_on_floor("wall", (0.1, 3.0, 2.5), Pose2(1.0, 0.0))
    table = box_on_floor("table", (0.8, 0.8, 0.7), Pose2(1.5, 0.0))
    assert share(images(cup(1.5, 0.0), wall)) == 0.0
    assert share(images(cup(1.5, 0.0), table)) > 0.7


def test_the_camera_sees_into_a_shelf_but_not_through_a_wardrobe():
    shelf = box_on_floor("shelf", (0.35, 1.0, 1.8), Pose2(1.8, 0.0))
    assert share(images(cup(1.8, 0.0, 1.0), shelf)) > 0.7
    assert share(images(cup(2.6, 0.0, 1.0), shelf)) == 0.0


def test_the_same_seed_gives_the_same_detections():
    assert images(cup(2.5, 0.0), seed=3) == images(cup(2.5, 0.0), seed=3)
    assert images(cup(2.5, 0.0), seed=3) != images(cup(2.5, 0.0), seed=4)


def test_a_robot_without_objects_has_no_detector():
    assert with_object_detector(ROBOT, []) is ROBOT
