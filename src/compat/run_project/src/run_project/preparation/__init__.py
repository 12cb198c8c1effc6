"""Preparation of a run: the built copy of the project, and the mount namespace in which it runs."""
