"""Merges the maps of several robots."""
