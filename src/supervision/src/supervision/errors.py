"""Errors of a run as a whole."""

from planar import PlanarError


class LaunchError(PlanarError):
    """The graph of nodes could not be started, or a node of it died.

    Args:
        text: Node and reason.
        is_bad_input: A node rejected its input (exit code 2).

    Attributes:
        is_bad_input: As given.
    """

    def __init__(self, text: str, is_bad_input: bool = False):
        super().__init__(text)
        self.is_bad_input = is_bad_input


class ResultError(PlanarError):
    """The result of a run cannot be written, so the run is no success for programs."""


class RunInterruptedError(KeyboardInterrupt):
    """Ctrl-C was pressed, or a signal asked the run to end."""

    def __init__(self) -> None:
        super().__init__("interrupted")
