"""Why a project cannot be run."""

from planar import PlanarError


class ProjectError(PlanarError):
    """What was named is not a project that can be run; the text says why."""


class BuildError(PlanarError):
    """The project's own packages cannot be built."""


class PlaceError(PlanarError):
    """The absolute paths that a project's files name cannot be provided here."""
