"""The parts of the cockpit that use ROS."""
