"""Sensors of a robot: each has frozen settings, a contract (``base``), and its own random generator."""
