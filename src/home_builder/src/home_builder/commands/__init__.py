"""The commands of the builder, one module each; a new module in this folder is found automatically."""

from supervision.command import CommandFolder

FOLDER = CommandFolder(__name__, __path__)
