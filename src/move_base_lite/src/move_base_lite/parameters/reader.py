"""Settings read out of nested dictionaries of parameters."""

from dataclasses import fields
from typing import Any, Dict, Iterable, List, Mapping

from planar.config.hints import hint
from planar.config.settings import settings_from


class Reader:
    """Reads dataclasses out of nested dictionaries and collects what is odd."""

    def __init__(self, where: str):
        self.where = where
        self.warnings: List[str] = []

    def read(self, kind, values: Mapping[str, Any], prefix: str, ignore: Iterable[str] = ()):
        """The settings ``kind`` from the values that are not dictionaries themselves."""
        flat = {
            name: value
            for name, value in values.items()
            if not isinstance(value, dict) and name not in ignore
        }
        settings, unknown = settings_from(kind, flat, where=self.where + prefix)
        self.report_unknown(unknown, prefix, [*names_of(kind), *ignore])
        return settings

    def report_unknown(self, names: Iterable[str], prefix: str, known: Iterable[str]) -> None:
        known = list(known)
        for name in names:
            self.warnings.append(f"unknown parameter {self.where}{prefix}{name}{hint(name, known)}")


def below(parameters: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    value = parameters.get(name, {})
    return value if isinstance(value, dict) else {}


def renamed(values: Mapping[str, Any], names: Mapping[str, str]) -> Dict[str, Any]:
    return {names.get(name, name): value for name, value in values.items()}


def names_of(kind) -> List[str]:
    return [item.name for item in fields(kind)]
