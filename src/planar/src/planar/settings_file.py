"""Settings out of a YAML file of parameters, without a parameter server."""

from pathlib import Path
from typing import List, Tuple, Type, TypeVar

import yaml

from planar.errors import SettingsError
from planar.settings import official_names, settings_from

T = TypeVar("T")


def settings_from_yaml(kind: Type[T], path: Path) -> Tuple[T, List[str]]:
    """The dataclass ``kind`` (fields made by ``parameter``) filled from a file; the names unknown to it.

    Raises SettingsError.
    """
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise SettingsError(f"{path}: {' '.join(str(error).split())}") from None
    if not isinstance(values, dict):
        raise SettingsError(f"{path}: not a table of parameters")
    return settings_from(kind, values, official_names(kind), f"{path}: ")
