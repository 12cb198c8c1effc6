"""People who walk about in a world, each to goals of their own, and give way to each other and to robots."""
