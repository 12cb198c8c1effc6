"""Particles: how they start, are moved, weighed and drawn anew, and what they say about the pose."""
