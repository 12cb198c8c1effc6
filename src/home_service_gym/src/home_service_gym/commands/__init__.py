"""The commands of the environments, one a module; a module that is put here is found."""

from home_service.command import CommandFolder

FOLDER = CommandFolder(__name__, __path__)
