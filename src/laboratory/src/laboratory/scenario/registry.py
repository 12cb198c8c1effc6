"""World sources and tasks by the keys that name them in a scenario file."""

from pathlib import Path
from typing import Callable, Dict

from laboratory.generators.buildings import area_reader
from laboratory.generators.crossings import read_crossings
from laboratory.generators.fields import read_fields
from laboratory.generators.halls import Halls
from laboratory.generators.homes import Homes
from laboratory.generators.offices import Offices
from laboratory.tasks.deliveries import read_errand, read_mission
from laboratory.tasks.generated_deliveries import read_chores
from laboratory.tasks.odom_goal import read_reach
from laboratory.tasks.service_day import read_service_day
from laboratory.tasks.task import Task
from laboratory.worlds.barn import read_barn
from laboratory.worlds.dynabarn import read_dynabarn
from laboratory.worlds.files import read_world_file
from laboratory.worlds.source import WorldSource
from planar.config.yaml_table import Table

# Readers by the keys of the table ``world``.
WORLD_SOURCES: Dict[str, Callable[[Table, Path], WorldSource]] = {
    "file": read_world_file,
    "barn": read_barn,
    "dynabarn": read_dynabarn,
    "homes": area_reader("homes", Homes),
    "offices": area_reader("offices", Offices),
    "halls": area_reader("halls", Halls),
    "fields": read_fields,
    "crossings": read_crossings,
}
# Readers by the keys of the table ``task``.
TASKS: Dict[str, Callable[[Table, Path], Task]] = {
    "errand": read_errand,
    "mission": read_mission,
    "chores": read_chores,
    "reach": read_reach,
    "service_day": read_service_day,
}
