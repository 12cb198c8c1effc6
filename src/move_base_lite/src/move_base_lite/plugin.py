"""Deprecated: use planar.extensions."""

from planar.deprecation import deprecated_names

__getattr__ = deprecated_names(
    __name__, {"Plugin": "planar.extensions:Plugin", "Registry": "planar.extensions:Registry"}
)
