"""Faults over ROS: of the simulator, and of what other people's nodes say to each other."""
