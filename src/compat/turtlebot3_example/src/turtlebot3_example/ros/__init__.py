"""The nodes of the examples."""
