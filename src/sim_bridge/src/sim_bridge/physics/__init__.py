"""Rigid-body physics in PyBullet: bodies, joints, contacts and wheeled robots."""
