"""Map files, map quality, and named places."""
