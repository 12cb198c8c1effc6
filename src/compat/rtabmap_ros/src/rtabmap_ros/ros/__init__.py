"""The ROS interface of rtabmap_ros."""
