"""A TurtleBot3 with ideal wheels and odometry, without physics."""
