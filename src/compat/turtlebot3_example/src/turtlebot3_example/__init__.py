"""Examples for the TurtleBot3."""
