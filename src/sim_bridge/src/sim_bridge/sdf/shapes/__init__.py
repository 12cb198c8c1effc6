"""Reads <geometry> and <material> elements."""
