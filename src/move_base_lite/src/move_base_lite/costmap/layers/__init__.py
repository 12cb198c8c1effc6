"""Layers of a costmap, one module each."""
