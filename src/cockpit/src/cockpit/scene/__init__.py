"""What a world and its robots look like: read in a process of its own, cut, and merged into few surfaces."""
