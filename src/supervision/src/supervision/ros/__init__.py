"""The graph of nodes that is supervised, and what its master and nodes answer."""
