import math

from add_markers import BoxPlacer, PlaceBox, RemoveBox, SolidBox
from planar import Pose2, grid_from_picture

ROBOT, SIZE = Pose2(1.0, 1.0, 0.0), 0.2
HALL = Pose2(1.5, 2.5, 0.0)


def solid(pose, name="cup"):
    return SolidBox(name, SIZE, pose)


def test_a_box_is_placed_in_front_of_its_place_carried_and_set_down_in_front_of_the_robot():
    bodies = BoxPlacer()
    (move,) = bodies.update([solid(HALL)], ROBOT)
    assert move == PlaceBox(solid(HALL), Pose2(2.0, 2.5, 0.0))
    assert bodies.update([solid(HALL)], ROBOT) == []
    assert bodies.update([solid(None)], ROBOT) == [PlaceBox(solid(None), None)]
    assert bodies.placed == {}
    (move,) = bodies.update([solid(HALL)], ROBOT)
    assert move.pose == Pose2(1.5, 1.0, 0.0)
    assert bodies.placed == {"cup": move.pose}


def test_a_box_is_put_where_the_map_has_room():
    bodies = BoxPlacer()
    bodies.grid = grid_from_picture("..#.\n..#.\n....", resolution=0.5, origin=Pose2(0.0, 0.0))
    (move,) = bodies.update([solid(Pose2(0.75, 1.0, 0.0))], ROBOT)
    assert bodies.grid.value_at(move.pose.x, move.pose.y) == 0
    assert move.pose.distance_to(Pose2(0.75, 1.0)) == 0.5
    assert abs(move.pose.yaw) < math.pi


def test_two_boxes_do_not_stand_in_each_other():
    bodies = BoxPlacer()
    moves = bodies.update([solid(HALL, "cup"), solid(HALL, "book")], ROBOT)
    assert moves[0].pose.distance_to(moves[1].pose) > SIZE * math.sqrt(2.0)


def test_boxes_that_the_next_mission_does_not_have_are_removed():
    bodies = BoxPlacer()
    bodies.update([solid(HALL, "cup"), solid(None, "book")], ROBOT)
    assert bodies.update([], ROBOT) == [RemoveBox("book"), RemoveBox("cup")]
    assert bodies.placed == {}


def test_a_box_is_not_put_into_the_robot():
    (move,) = BoxPlacer().update([solid(HALL)], robot=Pose2(2.0, 2.4, 0.0))
    assert move.pose.distance_to(HALL) == 0.5
    assert move.pose.distance_to(Pose2(2.0, 2.4)) > 0.4
