"""What can be wrong with experiments."""

from planar import PlanarError


class ResultsError(PlanarError):
    """The file of results cannot be used; the text names it."""


class WorkersError(PlanarError):
    """Nobody is there to play, or those who are have other software."""
