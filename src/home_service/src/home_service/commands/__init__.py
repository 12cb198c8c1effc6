"""Commands of the scripts, one a module; a new module needs no registration."""

from supervision.command import CommandFolder

FOLDER = CommandFolder(__name__, __path__)
