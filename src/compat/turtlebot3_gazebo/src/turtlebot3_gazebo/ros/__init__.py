"""What speaks ROS in turtlebot3_gazebo."""
