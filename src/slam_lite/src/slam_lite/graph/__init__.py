"""The pose graph: its best poses, how far off they may be, and what of it is let go."""
