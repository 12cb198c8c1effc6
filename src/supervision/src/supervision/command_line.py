"""Command lines as frozen dataclasses: a field is an option with its default, type and help text."""

import argparse
from dataclasses import MISSING, field, fields
from pathlib import Path
from typing import Any, List, Sequence, Type, TypeVar

Options = TypeVar("Options")
MEANING = "help"


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
    parser = argparse.ArgumentParser(
        prog=script,
        description=summary(kind),
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
        allow_abbrev=allow_abbreviations,
    )
    for item in fields(kind):  # type: ignore[arg-type]  # Python 3.8 has no type for "any dataclass"
        how = dict(item.metadata)
        if "flag" in how:
            flag = how.pop("flag") or "--" + item.name.replace("_", "-")
            default = argparse.SUPPRESS if item.default is None else item.default
            parser.add_argument(flag, dest=item.name, default=default, **how)
        elif how:
            parser.add_argument(item.name, **how)
    given = vars(parser.parse_args(words))
    return kind(**{name: tuple(value) if isinstance(value, list) else value for name, value in given.items()})


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
