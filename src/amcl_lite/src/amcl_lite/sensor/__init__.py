"""Sensor models: beams of a scan, their likelihood at a pose, and scan matching."""
