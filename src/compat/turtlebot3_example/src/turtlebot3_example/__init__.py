"""Examples for the TurtleBot3: patrol, obstacle stop, point operation, interactive marker."""
