"""What goes wrong between commands and wheels."""
