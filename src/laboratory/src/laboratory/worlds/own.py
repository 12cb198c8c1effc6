"""Deprecated name of laboratory.worlds.custom."""

from planar.deprecation import deprecated_names

__getattr__ = deprecated_names(
    __name__,
    {
        "CONTRACT": "laboratory.worlds.custom:CONTRACT",
        "Generator": "laboratory.worlds.custom:WorldGenerator",
        "OwnWorlds": "laboratory.worlds.custom:CustomWorlds",
    },
)
