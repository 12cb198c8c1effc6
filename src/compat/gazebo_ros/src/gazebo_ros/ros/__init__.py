"""The ROS interface of gazebo_ros."""
