"""ROS interface of home_service."""
