"""Conversion of messages and transforms to planar types and back."""
