"""What speaks ROS in gazebo_ros."""
