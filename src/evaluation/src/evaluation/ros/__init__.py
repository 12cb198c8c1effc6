"""Observers of a run over ROS, and the run itself."""
