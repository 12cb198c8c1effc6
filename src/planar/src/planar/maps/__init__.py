"""Occupancy grids, their files, and places in them."""
