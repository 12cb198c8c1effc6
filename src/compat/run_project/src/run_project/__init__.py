"""Run an existing home-service project, unmodified, on this workspace."""
