"""Exceptions of the simulator."""

from planar import PlanarError


class WorldError(PlanarError):
    """A world cannot be loaded or changed as requested.

    The text names the file and the element, or the model or link.
    """


class UnknownEntityError(WorldError):
    """No model, link, joint or robot has the given name."""


class RobotError(PlanarError):
    """A robot is unknown or its description cannot be used; the text names the file."""


class NoDriveError(RobotError):
    """A description has no plugin that drives the robot."""


class FaultError(PlanarError):
    """A user-defined fault kind has failed; the text names it."""
