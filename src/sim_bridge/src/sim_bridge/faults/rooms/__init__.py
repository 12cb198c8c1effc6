"""What happens to the home, and to where the robot is."""
