"""Runs other people's home-service projects on this workspace, without changing them."""
