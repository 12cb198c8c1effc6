"""Poses, scans and rays in the plane."""
