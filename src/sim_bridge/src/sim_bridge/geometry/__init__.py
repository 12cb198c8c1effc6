"""Poses in space, solids and meshes."""
