"""Messages and transforms made into planar types, and back."""
