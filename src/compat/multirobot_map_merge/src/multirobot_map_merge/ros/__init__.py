"""What speaks ROS in multirobot_map_merge."""
