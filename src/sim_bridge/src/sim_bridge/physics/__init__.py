"""Rigid bodies in PyBullet, and the wheeled robots among them."""
