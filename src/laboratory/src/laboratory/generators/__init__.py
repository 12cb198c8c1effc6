"""Worlds that nobody has drawn: the same from the same seed."""
