"""Scan matching to a local map: correlative search, then continuous refinement."""
