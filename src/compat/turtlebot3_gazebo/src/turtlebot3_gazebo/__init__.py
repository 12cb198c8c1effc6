"""Autonomous wandering of a TurtleBot3."""
