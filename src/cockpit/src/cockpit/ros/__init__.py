"""The parts of the cockpit that speak ROS."""
