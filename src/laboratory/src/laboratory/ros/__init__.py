"""Scenarios over the graph of nodes."""
