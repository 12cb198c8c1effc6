"""Parts of every node: entry point, start and end, parameters, readiness, checkpoints, connections."""
