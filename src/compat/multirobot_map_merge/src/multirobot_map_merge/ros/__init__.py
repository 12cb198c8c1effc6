"""The ROS interface of multirobot_map_merge."""
