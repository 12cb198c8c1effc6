"""Tasks of the environments."""
