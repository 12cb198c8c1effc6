"""The nodes of turtle_world."""
