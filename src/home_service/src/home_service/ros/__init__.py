"""What speaks ROS: runs and those who watch them, the commander, the player of bags."""
