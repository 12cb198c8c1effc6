"""Errors of the builder."""

from planar import PlanarError


class ImportPlanError(PlanarError):
    """A file cannot be imported as a plan; the text names the file and the reason."""
