"""Simulated time: lock-step with nodes, pausing, stepping, resetting."""
