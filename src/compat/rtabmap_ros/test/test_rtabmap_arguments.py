"""rtabmap's command line as slam_lite's."""

from rtabmap_ros.arguments import slam_lite_arguments

PARAMETERS = {"frame_id": "robot_footprint", "odom_frame_id": "/odom"}


def parameter(name, default):
    return PARAMETERS.get(name, default)


def test_the_map_is_called_as_the_grid_is_to_be_and_frames_are_those_of_rtabmap():
    words = ["--delete_db_on_start", "scan:=/scan", "grid_map:=/map", "__name:=rtabmap"]
    frames = ["_base_frame:=robot_footprint", "_odom_frame:=odom"]
    assert slam_lite_arguments(words, parameter) == [*words[1:], "map:=/map", *frames]


def test_without_a_remapping_the_map_is_the_grid_of_rtabmap():
    assert slam_lite_arguments([], lambda name, default: default) == ["map:=grid_map"]
