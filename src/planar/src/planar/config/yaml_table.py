"""Tables from YAML files; errors contain file, line and key."""

import math
from pathlib import Path
from typing import Any, Dict, Iterable, Iterator, List, Optional, Set, Tuple, Type

import yaml

from planar.config.bounded_yaml import MAX_BYTES, TAG, BoundedLoader, check_length
from planar.config.hints import hint_or_choices
from planar.errors import PlanarError, SettingsError
from planar.files.reading import read_text

_REQUIRED: Any = object()
# Longest value in a message [characters].
MAX_SHOWN = 200
# None stands for all other tags, which are refused.
_KNOWN = {None, *(TAG + kind for kind in ("null", "bool", "int", "float", "str", "seq", "map"))}


def read_table(
    path, error: Type[PlanarError] = SettingsError, missing: Optional[Type[PlanarError]] = None
) -> "Table":
    """Read a YAML file that holds a table.

    Args:
        path: File.
        error: Class of the errors for invalid content, also for values read from the table later.
        missing: Class of the error if there is no such file; by default ``error``.

    Returns:
        The outermost table.

    Raises:
        PlanarError: ``missing`` or ``error``, see above.
    """
    path = Path(path)
    try:
        text = read_text(path, MAX_BYTES)
    except FileNotFoundError:
        raise (missing or error)(f"{path}: no such file") from None
    except (OSError, UnicodeDecodeError) as problem:
        raise error(f"{path}: cannot be read ({problem})") from None
    return parse_table(text, str(path), error)


def parse_table(text: str, source: str, error: Type[PlanarError] = SettingsError) -> "Table":
    """Parse a YAML text that holds a table.

    Args:
        text: YAML.
        source: Name of the text in error messages.
        error: Class of the errors, also for values read from the table later.

    Returns:
        The outermost table.

    Raises:
        PlanarError: ``error``, if the text is not valid.
    """
    try:
        check_length(text)
    except ValueError as problem:
        raise error(f"{source}: {problem}") from None
    try:
        loader = _Loader(text)
        node = loader.get_single_node()
    except (yaml.YAMLError, RecursionError) as problem:
        mark = getattr(problem, "problem_mark", None)
        where = source if mark is None else f"{source}:{mark.line + 1}"
        what = getattr(problem, "problem", None) or "nested too deeply"
        raise error(f"{where}: not valid YAML ({what})") from None
    if not isinstance(node, yaml.MappingNode):
        raise error(f"{source}:1: expected a table of keys and values")
    document = _Document(source, loader, error)
    _check_keys(document, node)
    return Table(document, node, "")


class _Loader(BoundedLoader):
    """Loader restricted to the types of JSON: keys and dates are texts, binary data and sets errors."""

    yaml_constructors = {
        tag: constructor for tag, constructor in yaml.SafeLoader.yaml_constructors.items() if tag in _KNOWN
    }
    yaml_implicit_resolvers = {
        first: [(tag, pattern) for tag, pattern in resolvers if tag != f"{TAG}timestamp"]
        for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
    }

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> Dict[str, Any]:  # type: ignore[override]
        self.flatten_mapping(node)
        return {key.value: self.construct_object(value, deep=deep) for key, value in node.value}


class _Document:
    """State shared by all tables of one text."""

    def __init__(self, source: str, loader: yaml.SafeLoader, error: Type[PlanarError]):
        self.source, self.loader, self.error = source, loader, error

    def error_at(self, node: yaml.Node, text: str) -> PlanarError:
        return self.error(self.location_of(node) + text)

    def location_of(self, node: yaml.Node) -> str:
        return f"{self.source}:{node.start_mark.line + 1}: "


class Table:
    """Table of a YAML text that knows the line of each value.

    Its methods raise the error class of the text. A key without a value counts as missing.

    Attributes:
        name: Keys that lead to the table, joined by dots; empty for the outermost table.
    """

    def __init__(self, document: _Document, node: yaml.MappingNode, name: str):
        self.name = name
        self._document, self._node = document, node
        self._entries: Dict[str, Tuple[yaml.Node, yaml.Node]] = {}
        try:
            document.loader.flatten_mapping(node)
        except yaml.YAMLError:
            raise document.error_at(node, "'<<' must merge a table") from None
        for key, value in node.value:
            self._entries[key.value] = (key, value)

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __contains__(self, key: str) -> bool:
        return self.value(key) is not None

    def value(self, key: str) -> Any:
        """Return the value of a key as plain Python objects; None if it is missing."""
        if key not in self._entries:
            return None
        try:
            return self._document.loader.construct_object(self._entries[key][1], deep=True)
        except (yaml.YAMLError, ValueError, OverflowError, RecursionError) as problem:
            what = getattr(problem, "problem", None) or problem
            raise self.error_at(key, f"cannot be parsed ({what})") from None

    def values(self) -> Dict[str, Any]:
        """Return the whole table as plain Python objects."""
        return {key: self.value(key) for key in self}

    def number(self, key: str, default: float = _REQUIRED) -> float:
        """Return a finite number."""
        return self._as_number(key, self._needed(key, default))

    def numbers(self, key: str, names: str) -> Tuple[float, ...]:
        """Return a list of finite numbers, as many as ``names`` lists, e.g. ``x, y, yaw``."""
        values = self._needed(key)
        if not isinstance(values, list) or len(values) != len(names.split(", ")):
            raise self.error_at(key, f"must be [{names}], got {_shown(values)}")
        return tuple(self._as_number(key, value) for value in values)

    def count(self, key: str, default: int = _REQUIRED) -> int:
        """Return an integer of at least 1."""
        value = self._needed(key, default)
        if isinstance(value, bool) or not isinstance(value, int) or value < 1:
            raise self.error_at(key, f"must be a whole number from 1, got {_shown(value)}")
        return value

    def flag(self, key: str, default: bool = _REQUIRED) -> bool:
        """Return a boolean."""
        value = self._needed(key, default)
        if not isinstance(value, bool):
            raise self.error_at(key, f"must be true or false, got {_shown(value)}")
        return value

    def text(self, key: str, default: str = _REQUIRED) -> str:
        """Return a text that is not empty; a number counts as a text."""
        value = self._needed(key, default)
        if isinstance(value, (bool, dict, list)) or not str(value).strip():
            raise self.error_at(key, f"must be a text, got {_shown(value)}")
        return str(value)

    def path(self, key: str, folder: Path) -> Path:
        """Return the absolute path of a file or folder, relative to ``folder``; it need not exist."""
        try:
            path = (folder / Path(self.text(key)).expanduser()).resolve()
            path.exists()
        except (OSError, ValueError, RuntimeError) as problem:
            raise self.error_at(key, f"is not a valid path ({problem})") from None
        return path

    def texts(self, key: str) -> List[str]:
        """Return a list of texts; a single text is a list of one, a missing key an empty list."""
        values = self.value(key) or []
        values = values if isinstance(values, list) else [values]
        if any(isinstance(value, (bool, dict, list)) or value is None for value in values):
            raise self.error_at(key, f"must be a list of texts, got {_shown(values)}")
        return [str(value) for value in values]

    def choice(self, key: str, choices: Iterable[str], default: str = _REQUIRED) -> str:
        """Return a text that must be one of ``choices``."""
        value = self._needed(key, default)
        if not isinstance(value, str) or value not in choices:
            raise self.error_at(key, f"must be one of {', '.join(choices)}, got {_shown(value)}")
        return value

    def table(self, key: str) -> "Table":
        """Return the table under a key."""
        self._needed(key)
        node = self._entries[key][1]
        if not isinstance(node, yaml.MappingNode):
            raise self.error_at(key, f"must be a table of keys and values, got {_shown(self.value(key))}")
        return Table(self._document, node, self._full(key))

    def tables(self, key: str) -> List["Table"]:
        """Return the list of tables under a key; empty if the key is missing."""
        node = self._entries[key][1] if key in self else yaml.SequenceNode("", [])
        if not isinstance(node, yaml.SequenceNode):
            raise self.error_at(key, "must be a list of tables")
        for number, item in enumerate(node.value, 1):
            if not isinstance(item, yaml.MappingNode):
                text = f"{self._full(key)}[{number}] must be a table of keys and values"
                raise self._document.error_at(item, text)
        return [
            Table(self._document, item, f"{self._full(key)}[{number}]")
            for number, item in enumerate(node.value, 1)
        ]

    def allow_only(self, *known: str) -> None:
        """Raise an error that names every key that is not in ``known``, one a line."""
        unknown = [key for key in self if key not in known]
        if unknown:
            raise self._document.error("\n".join(self._unknown(key, known) for key in unknown))

    def check(self, condition: bool, key: str, requirement: str) -> None:
        """Raise the error ``<key> must be <requirement>`` unless a condition holds."""
        if not condition:
            raise self.error_at(key, f"must be {requirement}, got {_shown(self.value(key))}")

    def error_at(self, key: str, text: str) -> PlanarError:
        """Return the error ``<file>:<line>: <key> <text>``; without the key the line is that of the table."""
        return self._document.error_at(self._node_of(key), f"{self._full(key)} {text}")

    def location_of(self, key: str) -> str:
        """Return the prefix of ``key`` in error messages: file, line, and the keys that lead to it."""
        return self._document.location_of(self._node_of(key)) + self._full("")

    def _unknown(self, key: str, known: Iterable[str]) -> str:
        location = self._document.location_of(self._node_of(key))
        return f'{location}unknown key "{self._full(key)}"{hint_or_choices(key, known)}'

    def _node_of(self, key: str) -> yaml.Node:
        return self._entries[key][0] if key in self._entries else self._node

    def _full(self, key: str) -> str:
        return f"{self.name}.{key}" if self.name else key

    def _needed(self, key: str, default: Any = _REQUIRED) -> Any:
        value = self.value(key)
        if value is not None:
            return value
        if default is _REQUIRED:
            raise self.error_at(key, "is missing")
        return default

    def _as_number(self, key: str, value: Any) -> float:
        try:  # YAML 1.1 reads 1e-3 as a text
            number = float(value)
        except (TypeError, ValueError, OverflowError):
            number = math.nan
        if isinstance(value, bool) or not math.isfinite(number):
            raise self.error_at(key, f"must be a number, got {_shown(value)}")
        return number


def _shown(value: Any) -> str:
    """Return a value as it is shown in a message."""
    text = repr(value)
    return text if len(text) <= MAX_SHOWN else f"{text[:MAX_SHOWN]}..."


def _check_keys(document: _Document, root: yaml.Node) -> None:
    """Raise an error for keys that are no texts, or duplicates, of which YAML libraries use the last."""
    waiting: List[yaml.Node] = [root]
    met: Set[int] = set()
    while waiting:
        node = waiting.pop()
        if id(node) in met or isinstance(node, yaml.ScalarNode):
            continue
        met.add(id(node))
        if isinstance(node, yaml.SequenceNode):
            waiting.extend(node.value)
            continue
        seen: Dict[str, int] = {}
        for key, value in node.value:
            waiting.append(value)
            if not isinstance(key, yaml.ScalarNode):
                raise document.error_at(key, "keys must be texts")
            if key.value in seen:
                raise document.error_at(key, f'duplicate key "{key.value}", first in line {seen[key.value]}')
            seen[key.value] = key.start_mark.line + 1
