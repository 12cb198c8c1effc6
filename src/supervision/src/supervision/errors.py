"""What can go wrong with a run as a whole."""

from planar import PlanarError


class LaunchError(PlanarError):
    """The graph of nodes could not be brought up, or a part of it died.

    ``is_bad_input``: a node refused what it was given, and said so with exit code 2.
    """

    def __init__(self, text: str, is_bad_input: bool = False):
        super().__init__(text)
        self.is_bad_input = is_bad_input
