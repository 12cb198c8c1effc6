"""The parts of the node ``pick_objects`` that speak ROS."""
