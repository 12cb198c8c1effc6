"""The simulated world in the picture: its looks, its robots, and what is spawned into it."""
