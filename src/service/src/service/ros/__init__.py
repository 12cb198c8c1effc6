"""ROS interface of the service."""
