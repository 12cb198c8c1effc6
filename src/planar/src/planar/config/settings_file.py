"""Settings out of a YAML file of parameters, without a parameter server."""

from pathlib import Path
from typing import List, Tuple, Type, TypeVar

from planar.config.parameters import official_names
from planar.config.settings import settings_from
from planar.config.yaml_table import read_table

T = TypeVar("T")


def settings_from_yaml(kind: Type[T], path: Path) -> Tuple[T, List[str]]:
    """The dataclass ``kind`` (fields made by ``parameter``) filled from a file; the names unknown to it.

    Raises SettingsError.
    """
    table = read_table(path)
    return settings_from(kind, table.values(), official_names(kind), table.place_of)
