"""All tasks, by the key of a scenario's table ``task`` that names them."""

from pathlib import Path
from typing import Callable, Dict

from laboratory.tasks.chores import read_chores
from laboratory.tasks.deliveries import read_errand, read_mission
from laboratory.tasks.reach import read_reach
from laboratory.tasks.task import Task
from planar.config.yaml_table import Table

TASKS: Dict[str, Callable[[Table, Path], Task]] = {
    "errand": read_errand,
    "mission": read_mission,
    "chores": read_chores,
    "reach": read_reach,
}
