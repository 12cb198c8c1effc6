"""Command lines as frozen dataclasses: a field is an option with its default, type and help text."""

import argparse
import inspect
from dataclasses import MISSING, Field, field, fields
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Type, TypeVar

Options = TypeVar("Options")
MEANING = "help"
COLUMNS = 120
# Defaults below this folder, that of the repository, are shown relative to it.
ROOT = Path(__file__).resolve().parents[4]
NUMBERS = (int, float, Optional[int], Optional[float])


def option(default: Any, meaning: str, **how: Any) -> Any:
    """Define a field that is an option.

    Args:
        default: Default value; False makes the option a flag, None is not shown by ``--help``.
        meaning: Help text.
        **how: Arguments of argparse's add_argument; ``flag`` replaces the name made of the field's name.
    """
    if default is False:
        how["action"] = "store_true"
    return field(default=default, metadata={MEANING: meaning, "flag": None, **how})


def argument(meaning: str, default: Any = MISSING, **how: Any) -> Any:
    """Define a field that is a positional argument.

    Args:
        meaning: Help text.
        default: Only for dataclasses in which a field with a default precedes; the argument is required
            anyway.
        **how: Arguments of argparse's add_argument.
    """
    return field(default=default, metadata={MEANING: meaning, **how})


def parse(
    kind: Type[Options], words: Sequence[str], script: str, allow_abbreviations: bool = True
) -> Options:
    """Parse a command line; exits on ``--help`` and on invalid options.

    Args:
        kind: Dataclass of the options; fields made by neither ``option`` nor ``argument`` keep their
            defaults.
        words: Command line.
        script: Name of the program in messages.
        allow_abbreviations: Accept unique prefixes of options.
    """
    parser = _parser(kind, script, allow_abbreviations)
    if any(item.metadata.get("nargs") in ("*", "?") for item in fields(kind)):  # type: ignore[arg-type]
        if not {"-h", "--help"}.isdisjoint(words):  # the next method prints no placeholders
            parser.parse_args(["--help"])
        given = vars(parser.parse_intermixed_args(words))
    else:
        given = vars(parser.parse_args(words))
    return kind(**{name: tuple(value) if isinstance(value, list) else value for name, value in given.items()})


def usage(kind: type, script: str) -> str:
    """Return the text that ``--help`` prints.

    Args:
        kind: Dataclass of the options. Its docstring, up to the section of attributes, describes the
            command; the fields of the class itself precede those that it inherits.
        script: How the program is called.
    """
    return _parser(kind, script).format_help()


def _parser(kind: type, script: str, allow_abbreviations: bool = True) -> argparse.ArgumentParser:
    described = {item.name: item for item in fields(kind) if item.metadata}
    own_first = dict.fromkeys(name for base in kind.__mro__ for name in vars(base).get("__annotations__", ()))
    items = [described[name] for name in own_first if name in described]
    parser = argparse.ArgumentParser(
        prog=script,
        usage=" ".join([script, *filter(None, map(_placeholder, items)), "[options]"]),
        description=inspect.cleandoc(kind.__doc__ or "").partition("\n\nAttributes:")[0],
        formatter_class=_Formatter,
        allow_abbrev=allow_abbreviations,
        add_help=False,
    )
    # Titles of argparse's own groups differ between versions of Python.
    arguments, options = parser.add_argument_group("arguments"), parser.add_argument_group("options")
    for item in items:
        how = _settings(item)
        flag = how.pop("flag", "")
        if flag:
            default = argparse.SUPPRESS if item.default is None else item.default
            options.add_argument(flag, dest=item.name, default=default, **how)
        else:
            arguments.add_argument(item.name, **how)
    options.add_argument("-h", "--help", action="help", help="print this text")
    return parser


class _Formatter(argparse.RawDescriptionHelpFormatter):
    """Formats for the same width on every terminal, as the text is also a file."""

    def __init__(self, prog: str):
        super().__init__(prog, max_help_position=20, width=COLUMNS)


def _settings(item: "Field[Any]") -> Dict[str, Any]:
    """Return the arguments of argparse's add_argument, with the flag of an option."""
    how = dict(item.metadata)
    if "flag" in how:
        how["flag"] = how["flag"] or "--" + item.name.replace("_", "-")
    metavar = _metavar(item, how)
    if metavar:
        how.setdefault("metavar", metavar)
    default = _shown_default(item.default) if "flag" in how else ""
    how[MEANING] = (how[MEANING] + (f" (default: {default})" if default else "")).replace("%", "%%")
    return how


def _metavar(item: "Field[Any]", how: Mapping[str, Any]) -> str:
    """Return the placeholder of the values of an option without one; empty: argparse's."""
    if "action" in how:
        return ""
    if "choices" in how:
        return "|".join(how["choices"])
    if how.get("type") is Path:
        return "FILE"
    return "N" if item.type in NUMBERS else ""


def _placeholder(item: "Field[Any]") -> str:
    """Return an argument as it stands in the line of usage; empty for an option."""
    if "flag" in item.metadata:
        return ""
    repetitions = {"+": "{}...", "*": "[{}...]", "?": "[{}]"}
    return repetitions.get(item.metadata.get("nargs", ""), "{}").format(
        item.metadata.get("metavar", item.name)
    )


def _shown_default(value: Any) -> str:
    """Return a default for people; empty if there is none to show."""
    if value is MISSING or value is None or value is False or value == ():
        return ""
    if isinstance(value, Path):
        return str(value.relative_to(ROOT) if ROOT in value.parents else value)
    if isinstance(value, float):
        return f"{value:g}"
    return " ".join(map(_shown_default, value)) if isinstance(value, tuple) else str(value)


def words(options: Any) -> List[str]:
    """Return the command line that ``parse`` converts to these options, without those at their defaults."""
    arguments: List[str] = []
    for item in fields(options):
        value = getattr(options, item.name)
        if value == item.default or not item.metadata:
            continue
        if "flag" in item.metadata:
            arguments.append(item.metadata["flag"] or "--" + item.name.replace("_", "-"))
        values = value if isinstance(value, tuple) else () if value is True else (value,)
        arguments += [str(one.resolve()) if isinstance(one, Path) else str(one) for one in values]
    return arguments


def summary(kind: type) -> str:
    """Return the first line of a class's docstring."""
    return (kind.__doc__ or "").partition("\n")[0]


def seconds(text: str) -> float:
    """Convert an argument to a positive duration [s]."""
    value = number(text)
    if not value > 0.0:
        raise argparse.ArgumentTypeError(f"{text} is not positive")
    return value


def seed(text: str) -> int:
    """Convert an argument to a whole number from 0."""
    return _whole_number(text, 0)


def count(text: str) -> int:
    """Convert an argument to a whole number from 1."""
    return _whole_number(text, 1)


def number(text: str) -> float:
    """Convert an argument to a number."""
    try:
        return float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number") from None


def _whole_number(text: str, least: int) -> int:
    if not text.isascii() or not text.isdigit() or int(text) < least:
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from {least}")
    return int(text)
