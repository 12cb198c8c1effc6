"""Pedestrians that walk to their goals and avoid each other and robots (social force model)."""
