"""How simulated time passes: lock-step with nodes, pausing, stepping, resetting."""
