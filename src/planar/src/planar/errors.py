"""The root of every error that a core of this workspace raises on purpose."""


class PlanarError(Exception):
    """Something is impossible for a reason that a person can read in the text."""


class SettingsError(PlanarError):
    """A parameter, option or configuration file holds something that cannot be used."""
