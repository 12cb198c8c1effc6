"""Custom world generators: ``world: {my_package.my_module/MyWorlds: {rooms: 3}}`` in a scenario."""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Iterable, Protocol, Tuple

from laboratory.plugin_files import source_files
from laboratory.results.version import packages
from laboratory.worlds.source import Arena
from planar import PlanarError
from planar.config.settings import settings_from
from planar.config.yaml_table import Table
from planar.extensions import ExtensionPoint, InvalidAnswer, PluginError
from sim_bridge import WorldError


class WorldGenerator(Protocol):
    """A frozen dataclass whose fields (numbers, strings, booleans) can be set in a scenario."""

    def arena(self, seed: int) -> Arena:
        """Return the world of a seed; all random numbers come from the seed."""
        ...


def _requirements(found: Any) -> Iterable[str]:
    parameters = getattr(found, "__dataclass_params__", None)
    if parameters is None or not parameters.frozen:
        yield "it is not a frozen dataclass"


def _checked(arena: Any, seed: int) -> Arena:
    if not isinstance(arena, Arena):
        raise InvalidAnswer(f"returned a {type(arena).__name__}, expected an Arena")
    return arena


CONTRACT: ExtensionPoint[WorldGenerator] = ExtensionPoint(
    "world generator",
    WorldGenerator,
    "laboratory.worlds",
    WorldError,
    passes=(PlanarError,),
    answers={"arena": _checked},
    requirements=_requirements,
)


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
        return CONTRACT.guarded(self.name, lambda: self.generator).arena(seed)

    def files(self) -> Tuple[Path, ...]:
        """Return its source files: changed code makes stored results invalid."""
        return source_files((self.name,), packages())

    def arena_number(self, seed: int) -> int:
        return seed


def read_custom_worlds(table: Table, name: str) -> CustomWorlds:
    """Read the table of the generator with this dotted name."""
    table.allow_only(name)
    values = table.table(name)
    try:
        generator_class: Any = CONTRACT.load_required(name)
        where = values.location_of
        generator, unknown = settings_from(
            generator_class, {key: values.value(key) for key in values}, where=where
        )
    except (PluginError, TypeError) as error:  # TypeError: a field without a default is not set
        raise table.error_at(name, f"cannot be used: {error}") from None
    if unknown:
        values.allow_only(*(field.name for field in fields(generator_class)))
    return CustomWorlds(name, generator)
