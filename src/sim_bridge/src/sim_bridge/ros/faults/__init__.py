"""Fault injection over ROS: into the simulator, and into messages between external nodes."""
