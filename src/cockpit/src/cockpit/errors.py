"""Errors of the cockpit, reported on the page or in the terminal."""

from planar import PlanarError


class CockpitError(PlanarError):
    """A request cannot be carried out; the text is shown to the user."""


class PortError(CockpitError):
    """The page cannot be served at the requested address."""


class RefusedError(CockpitError):
    """A browser sent a message that the page never sends."""
