"""Scans: their beams, how well these fit the map at a pose, and the pose near by at which they fit best."""
