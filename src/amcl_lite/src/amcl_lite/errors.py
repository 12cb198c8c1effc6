"""What can go wrong in localization."""

from planar import PlanarError


class LocalizationError(PlanarError):
    """Localization is impossible with what it was given."""
