"""The simulated world on the page: its visual parts, its robots, and spawned models."""
