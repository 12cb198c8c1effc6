"""Errors of the service."""

from typing import Sequence

from planar import PlanarError


class RequestError(PlanarError):
    """A request is invalid, or contradicts the open ones.

    Attributes:
        problems: One text for each problem, which starts with the key it concerns.
    """

    def __init__(self, problems: Sequence[str]):
        super().__init__("; ".join(problems))
        self.problems = tuple(problems)


class QueueFullError(PlanarError):
    """As many requests are open as the queue holds."""


class UnknownTaskError(PlanarError):
    """There is no task or series of that id."""


class TaskEndedError(PlanarError):
    """The task has ended and cannot be changed."""


class JournalError(PlanarError):
    """The journal cannot be read or written; the text names its file and what to do."""
