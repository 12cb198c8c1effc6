"""One map of those of several robots."""
