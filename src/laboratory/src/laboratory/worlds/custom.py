"""Worlds of other people: ``world: {my_package.my_module/MyWorlds: {rooms: 3}}`` in a scenario."""

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
    """A frozen dataclass. Its fields, of numbers, texts and flags, are what a scenario may say of it."""

    def arena(self, seed: int) -> Arena:
        """The same for the same seed; all chance comes from it."""
        ...


CONTRACT = PluginContract("generator of worlds", WorldGenerator, None, "laboratory.worlds")


@dataclass(frozen=True)
class CustomWorlds:
    """The WorldSource that other people's generator is: what goes wrong in it is told in its name."""

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
            raise WorldError(f"{self.name} gave a {type(arena).__name__}, not an Arena")
        return arena

    def files(self) -> Tuple[Path, ...]:
        """Its source: results of another one are not of the same scenario."""
        return source_files((self.name,))

    def arena_number(self, seed: int) -> int:
        return seed


def read_custom_worlds(table: Table, name: str) -> CustomWorlds:
    """Those whose dotted name is a key of a scenario's table ``world``."""
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
    except TypeError as error:  # a field without a default that the scenario does not give
        raise table.error_at(name, f"cannot be used: {error}") from None
    if unknown:
        values.allow_only(*(field.name for field in fields(generator_class)))
    return CustomWorlds(name, generator)


def load_generator(name: str) -> type:
    """Other people's generator of that dotted name. Raises PluginError with what it lacks."""
    generator_class = load_plugin(name, CONTRACT)
    if generator_class is None:
        raise PluginError("there is no such entry point of laboratory.worlds")
    if not (is_dataclass(generator_class) and generator_class.__dataclass_params__.frozen):  # type: ignore[attr-defined]
        raise PluginError(f"{name} is no generator of worlds: it is no frozen dataclass")
    return generator_class
