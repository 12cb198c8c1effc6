"""Bags, read."""
