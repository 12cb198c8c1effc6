"""Nodes that do not support lock-step: whether they rest, and when simulated time may pass."""
