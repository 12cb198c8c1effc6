"""What robots have to do."""
