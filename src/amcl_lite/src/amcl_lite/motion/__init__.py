"""Odometry: how it moves the particles, and when the robot has moved enough for a scan to count."""
