"""What the Navigator is asked: goals, and plans for others."""
