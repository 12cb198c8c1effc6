"""Poses, grids, scans and ray casting in the plane."""
