"""ROS nodes: move_base's action, topics, services and parameters around the Navigator."""
