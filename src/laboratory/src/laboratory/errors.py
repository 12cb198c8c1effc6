"""Errors of campaigns and their results."""

from planar import PlanarError


class ResultsError(PlanarError):
    """The file of results cannot be read or written; the text names it."""


class WorkersError(PlanarError):
    """No worker is available, or a worker has another version of the software."""
