"""Custom world generators: ``world: {my_package.my_module/MyWorlds: {rooms: 3}}`` in a scenario."""

from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any, Protocol, Tuple

from laboratory.worlds.source import Arena
from planar import PlanarError
from planar.config.settings import settings_from
from planar.config.yaml_table import Table
from planar.plugins import PluginContract, PluginError, load_plugin, source_files
from sim_bridge import WorldError


class WorldGenerator(Protocol):
    """A frozen dataclass whose fields (numbers, strings, booleans) can be set in a scenario."""

    def arena(self, seed: int) -> Arena:
        """Return the world of a seed; all random numbers come from the seed."""
        ...


CONTRACT = PluginContract("world generator", WorldGenerator, None, "laboratory.worlds")


@dataclass(frozen=True)
class CustomWorlds:
    """World source of a custom generator; its exceptions become WorldErrors that name the generator.

    Attributes:
        name: Dotted name of the generator's class.
        generator: The generator.
    """

    name: str
    generator: WorldGenerator

    def arena(self, seed: int) -> Arena:
        try:
            arena = self.generator.arena(seed)
        except PlanarError:
            raise
        except Exception as error:
            raise WorldError(f"{self.name} raised {type(error).__name__}: {error}") from error
        if not isinstance(arena, Arena):
            raise WorldError(f"{self.name} returned a {type(arena).__name__}, expected an Arena")
        return arena

    def files(self) -> Tuple[Path, ...]:
        """Return its source files: changed code makes stored results invalid."""
        return source_files((self.name,))

    def arena_number(self, seed: int) -> int:
        return seed


def read_custom_worlds(table: Table, name: str) -> CustomWorlds:
    """Read the table of the generator with this dotted name."""
    table.allow_only(name)
    values = table.table(name)
    try:
        generator_class: Any = load_generator(name)
        where = values.location_of
        generator, unknown = settings_from(
            generator_class, {key: values.value(key) for key in values}, where=where
        )
    except PluginError as error:
        raise table.error_at(name, f"cannot be used: {error}") from None
    except TypeError as error:  # the scenario does not set a field without a default
        raise table.error_at(name, f"cannot be used: {error}") from None
    if unknown:
        values.allow_only(*(field.name for field in fields(generator_class)))
    return CustomWorlds(name, generator)


def load_generator(name: str) -> type:
    """Import a custom generator by its dotted name. Raises PluginError if it violates the contract."""
    generator_class = load_plugin(name, CONTRACT)
    if generator_class is None:
        raise PluginError("there is no such entry point of laboratory.worlds")
    if not (is_dataclass(generator_class) and generator_class.__dataclass_params__.frozen):  # type: ignore[attr-defined]
        raise PluginError(f"{name} is not a world generator: it is not a frozen dataclass")
    return generator_class
