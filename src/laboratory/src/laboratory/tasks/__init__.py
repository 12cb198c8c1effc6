"""Tasks of scenarios."""
