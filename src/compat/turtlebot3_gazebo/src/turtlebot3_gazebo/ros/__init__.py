"""The ROS interface of turtlebot3_gazebo."""
