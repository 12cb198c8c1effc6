"""The parts of the node ``amcl`` that speak ROS."""
