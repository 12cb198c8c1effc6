"""Searches over what is played: for better parameters, and for what breaks the robot."""
