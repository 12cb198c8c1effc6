"""Matching the surface seen by a scan to a local map: a coarse search, then continuous refinement."""
