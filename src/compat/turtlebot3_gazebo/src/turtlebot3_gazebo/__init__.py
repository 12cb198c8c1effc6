"""What drives a TurtleBot3 about by itself."""
