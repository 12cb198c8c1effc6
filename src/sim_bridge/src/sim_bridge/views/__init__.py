"""Views of a world: cross-sections for range finders, triangles for cameras, images, true maps."""
