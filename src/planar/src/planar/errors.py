"""Base classes of the errors that the cores raise on purpose."""


class PlanarError(Exception):
    """Root of the errors of this project; the text explains the reason to a person."""


class SettingsError(PlanarError):
    """A parameter, option or configuration file is invalid."""


class FileWriteError(PlanarError):
    """A file cannot be written; the previous content is kept. The text names the file."""


class OutOfRangeError(PlanarError):
    """A number is not finite or implausibly large; the text names it."""
