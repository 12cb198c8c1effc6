"""Published topics: commands, plans, costmaps, zones, progress and outcome of goals."""
