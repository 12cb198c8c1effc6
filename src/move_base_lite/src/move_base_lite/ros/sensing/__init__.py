"""Inputs of the Navigator: transforms, odometry, sensor data."""
