"""The parts of the node ``turtle_world`` that speak ROS."""
