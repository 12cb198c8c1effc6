"""What is wrong with a ROS graph. No ROS."""
