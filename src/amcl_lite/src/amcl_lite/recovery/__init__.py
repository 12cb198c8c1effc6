"""Beyond amcl: noticing that the robot is lost, and where it may be then."""
