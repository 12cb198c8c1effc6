"""Map observations."""
