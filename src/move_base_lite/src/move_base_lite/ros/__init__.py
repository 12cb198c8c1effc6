"""Between move_base's topics, services and action, and the Navigator."""
