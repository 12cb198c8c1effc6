"""What the Navigator shows: commands, plans, costmaps, zones, how a goal stands."""
