"""Supervision of a run: graph of nodes, run folder, Ctrl-C, terminal output."""
