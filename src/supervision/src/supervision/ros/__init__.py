"""Supervised graph of nodes, and queries to its master and nodes."""
