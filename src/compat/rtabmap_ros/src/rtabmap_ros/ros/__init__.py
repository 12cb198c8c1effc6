"""What speaks ROS in rtabmap_ros."""
