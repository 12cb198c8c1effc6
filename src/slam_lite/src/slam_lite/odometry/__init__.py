"""Odometry: checks of its continuity, and its error model."""
