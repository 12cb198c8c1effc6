"""Procedural world generators; the same seed gives the same world."""
