"""All sources of worlds, by the key of a scenario's table ``world`` that names them."""

from pathlib import Path
from typing import Callable, Dict

from laboratory.generators.buildings import reader_of
from laboratory.generators.crossings import read_crossings
from laboratory.generators.fields import read_fields
from laboratory.generators.halls import Halls
from laboratory.generators.homes import Homes
from laboratory.generators.offices import Offices
from laboratory.worlds.barn import read_barn
from laboratory.worlds.dynabarn import read_dynabarn
from laboratory.worlds.files import read_world_file
from laboratory.worlds.source import WorldSource
from planar.config.yaml_table import Table

SOURCES: Dict[str, Callable[[Table, Path], WorldSource]] = {
    "file": read_world_file,
    "barn": read_barn,
    "dynabarn": read_dynabarn,
    "homes": reader_of("homes", Homes),
    "offices": reader_of("offices", Offices),
    "halls": reader_of("halls", Halls),
    "fields": read_fields,
    "crossings": read_crossings,
}
