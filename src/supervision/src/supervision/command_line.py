"""A command line as a frozen dataclass: a field is an option, with its default, its kind and its meaning."""

import argparse
from dataclasses import MISSING, field, fields
from pathlib import Path
from typing import Any, List, Sequence, Type, TypeVar

Options = TypeVar("Options")
MEANING = "help"


def option(default: Any, meaning: str, **how: Any) -> Any:
    """A field for the option named like it, or ``flag``; ``how`` is for argparse's add_argument.

    What is False by default is switched on by the option alone. A default of None is not told by ``--help``.
    """
    if default is False:
        how["action"] = "store_true"
    return field(default=default, metadata={MEANING: meaning, "flag": None, **how})


def argument(meaning: str, default: Any = MISSING, **how: Any) -> Any:
    """A field for an argument that is told by its position; ``how`` as above.

    ``default``: for dataclasses alone, where a field with a default comes before; the argument must be given.
    """
    return field(default=default, metadata={MEANING: meaning, **how})


def parse(
    kind: Type[Options], words: Sequence[str], script: str, allow_abbreviations: bool = True
) -> Options:
    """The options that ``words`` give; ends the process on --help, and on nonsense in the name of ``script``.

    A field that is made by neither ``option`` nor ``argument`` keeps its default.
    """
    parser = argparse.ArgumentParser(
        prog=script,
        description=summary(kind),
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
        allow_abbrev=allow_abbreviations,
    )
    for item in fields(kind):  # type: ignore[arg-type]  # nothing says "any dataclass" in Python 3.8
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
    """The words that ``parse`` makes these options of; those that are as by default are left out."""
    told: List[str] = []
    for item in fields(options):
        value = getattr(options, item.name)
        if value == item.default or not item.metadata:
            continue
        if "flag" in item.metadata:
            told.append(item.metadata["flag"] or "--" + item.name.replace("_", "-"))
        values = value if isinstance(value, tuple) else () if value is True else (value,)
        told += [str(one.resolve()) if isinstance(one, Path) else str(one) for one in values]
    return told


def summary(kind: type) -> str:
    """What it is for: the first line of its docstring."""
    return (kind.__doc__ or "").partition("\n")[0]
