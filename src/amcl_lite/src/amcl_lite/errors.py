"""Errors of localization."""

from planar import PlanarError


class LocalizationError(PlanarError):
    """The inputs do not allow localization."""
