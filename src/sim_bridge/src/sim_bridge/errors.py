"""What can be wrong with what a simulation is made of."""

from planar import PlanarError


class WorldError(PlanarError):
    """A world cannot be built; the text names the file and the element."""


class UnknownEntityError(WorldError):
    """There is no model, link or robot of that name."""


class RobotError(PlanarError):
    """A robot is unknown or its description cannot be used."""


class NoDriveError(RobotError):
    """A description is of something that nothing drives."""


class FaultError(PlanarError):
    """A kind of fault of somebody's own has failed; the text names it."""
