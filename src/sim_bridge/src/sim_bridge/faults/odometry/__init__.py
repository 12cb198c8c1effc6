"""What goes wrong with odometry."""
