"""The projects of the course before the home-service robot: what they are, and how they went."""
