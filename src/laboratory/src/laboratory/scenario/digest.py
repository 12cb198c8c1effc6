"""Digests of scenarios, by which stored results are found."""

import hashlib
import json
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, Dict, Iterator, List

from laboratory.plugin_files import source_files
from laboratory.results.version import packages, version_over_ros
from planar import SettingsError
from planar.files.reading import is_file

# Fields that do not change a run.
_IGNORED: Dict[str, Any] = {"name": "", "about": "", "seeds": (), "file": None}
# Names of classes and fields in digests from before they were renamed, so that stored results stay valid.
_CLASS_NAMES = {
    "CrossingCylinders": "Crossings",
    "CustomWorlds": "OwnWorlds",
    "CylinderFields": "Fields",
    "DeliveryTask": "Deliveries",
    "GeneratedDeliveryTask": "Chores",
    "OdomGoalTask": "Reach",
}
_FIELD_NAMES = {
    "max_area": "largest",
    "max_count": "most",
    "max_speed": "fastest",
    "min_area": "least",
    "min_count": "fewest",
    "min_speed": "slowest",
    "routes": "walks",
    "unspecified": "anyone",
}


def scenario_digest(scenario: Any) -> str:
    """Compute a digest that two scenarios share only if their runs are the same.

    It covers all values but the name, the description and the seeds, the contents of the scenario's files,
    and the files of custom planners, faults, world generators and all other plugins that its parameters name.

    Args:
        scenario: A Scenario.

    Returns:
        16 hexadecimal digits.

    Raises:
        PlanarError: A file of the scenario cannot be read.
    """
    values = {**_plain(scenario), **_IGNORED}
    if not scenario.localizer:  # so that results from before it existed stay valid
        del values["localizer"]
    kinds = [_class_name(scenario.world), _class_name(scenario.task)]
    names = (scenario.planner, *(fault.kind for fault in scenario.faults), *_texts(scenario.parameters))
    custom = (*source_files(names, packages()), *_files_named(scenario.parameters))
    files = [_content(path) for path in (*scenario.world.files(), *scenario.task.files(), *custom)]
    software = [version_over_ros()] if scenario.is_over_ros else []
    text = json.dumps([kinds, files, software, values], sort_keys=True, default=_without_path)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def _plain(value: Any) -> Any:
    """Convert as ``dataclasses.asdict`` does, with the names of old digests."""
    if is_dataclass(value) and not isinstance(value, type):
        is_own = type(value).__module__.startswith("laboratory.")
        return {
            _FIELD_NAMES.get(field.name, field.name) if is_own else field.name: _plain(
                getattr(value, field.name)
            )
            for field in fields(value)
        }
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    if isinstance(value, dict):
        return {key: _plain(each) for key, each in value.items()}
    return value


def _texts(value: Any) -> Iterator[str]:
    """Yield all texts in nested parameters."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, (list, tuple, dict)):
        for each in value.values() if isinstance(value, dict) else value:
            yield from _texts(each)


def _files_named(parameters: Any) -> List[Path]:
    """Return the files that parameters name, such as weights."""
    return [Path(text) for text in _texts(parameters) if text and is_file(Path(text))]


def _class_name(value: Any) -> str:
    name = type(value).__name__
    return _CLASS_NAMES.get(name, name)


def _without_path(value: Any) -> Any:
    """Where a file lies does not count, only its content."""
    return None if isinstance(value, Path) else str(value)


def _content(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError as error:
        raise SettingsError(f"{path}: {error.strerror}") from None
