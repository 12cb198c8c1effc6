"""A TurtleBot3 of wheels and odometry alone."""
