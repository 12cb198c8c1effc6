"""From commands to the speeds of wheels."""
