"""rtabmap's command line is translated to slam_lite's."""

from rtabmap_ros.arguments import slam_lite_arguments

PARAMETERS = {"frame_id": "robot_footprint", "odom_frame_id": "/odom"}


def parameter(name, default):
    return PARAMETERS.get(name, default)


def test_the_map_gets_the_topic_of_the_grid_and_the_frames_of_rtabmap():
    words = ["--delete_db_on_start", "scan:=/scan", "grid_map:=/map", "__name:=rtabmap"]
    frames = ["_base_frame:=robot_footprint", "_odom_frame:=odom"]
    assert slam_lite_arguments(words, parameter) == [*words[1:], "map:=/map", *frames]


def test_without_a_remapping_the_map_is_published_as_grid_map():
    assert slam_lite_arguments([], lambda name, default: default) == ["map:=grid_map"]
