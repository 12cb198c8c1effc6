"""Loops: places that were seen before, told by their looks and by the graph."""
