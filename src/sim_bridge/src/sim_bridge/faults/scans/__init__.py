"""What goes wrong with a laser."""
