"""The parts of the node ``add_markers`` that speak ROS."""
