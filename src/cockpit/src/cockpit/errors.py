"""What the cockpit cannot do, told on its page or in the terminal."""

from planar import PlanarError


class CockpitError(PlanarError):
    """Something cannot be shown or done; the text is for the person at the page."""


class PortError(CockpitError):
    """The page cannot be served where it was asked for."""


class RefusedError(CockpitError):
    """A browser sent what no page of ours sends."""
