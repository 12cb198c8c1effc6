"""Commands of the scripts, one a module; a new module needs no registration."""

from home_service.command import CommandFolder

FOLDER = CommandFolder(__name__, __path__)
