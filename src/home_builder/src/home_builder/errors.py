"""Errors of the builder."""

from typing import Sequence

from planar import PlanarError


class HomeBuilderError(PlanarError):
    """Root of the errors of the builder."""


class ImportPlanError(HomeBuilderError):
    """A file cannot be imported as a plan; the text names the file and the reason."""


class EditorError(HomeBuilderError):
    """The editor cannot be served, or is asked for what it cannot do now.

    The text is shown on the page or in the terminal; the plan is kept as it was.
    """


class InvalidPlanError(HomeBuilderError):
    """No home can be built from a plan.

    Args:
        problems: A sentence for each error, with its point.
    """

    def __init__(self, problems: Sequence[str]):
        super().__init__("the plan has errors:\n  " + "\n  ".join(problems))
