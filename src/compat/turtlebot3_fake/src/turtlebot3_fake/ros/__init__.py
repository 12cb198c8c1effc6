"""The ROS interface of turtlebot3_fake."""
