"""What is known of the ground around a robot."""
