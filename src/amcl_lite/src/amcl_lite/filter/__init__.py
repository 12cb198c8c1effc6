"""Particle filter: initialization, prediction, weighting, resampling and statistics."""
