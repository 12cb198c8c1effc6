"""Bags made and played as processes and nodes of their own."""
