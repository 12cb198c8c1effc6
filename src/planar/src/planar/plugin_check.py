"""What any plugin has to do, whoever wrote it: checks of each kind, ``python3 -m PACKAGE.check NAME``.

A check is a function whose docstring says what is asked, and that raises CheckFailed with what was found
instead. The unit tests hold the project's own to the same.
"""

import argparse
import sys
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Callable, Iterator, List, Mapping, Optional, Sequence, Tuple, Type

from planar.errors import PlanarError
from planar.plugins import PluginContract, PluginError, load_plugin

Check = Callable[[Any], None]


class CheckFailed(Exception):  # noqa: N818  -- it is the plugin that has erred
    """A plugin does not do what its contract says; the text is what it does."""


@dataclass(frozen=True)
class CheckSuite:
    """A kind of plugin and what each of it has to do.

    ``find``: gives what the checks are made with for a name, None if there is no such plugin of this kind;
    raises PluginError with what it lacks.
    """

    find: Callable[[str], Any]
    checks: Tuple[Check, ...]


def plugin_finder(contract: PluginContract, made_of: Callable[[str], Any]) -> Callable[[str], Any]:
    """Make a CheckSuite's ``find`` for custom classes: ``made_of`` makes what to check of a name."""
    return lambda name: None if load_plugin(name, contract) is None else made_of(name)


def expect(is_so: bool, text: str) -> None:
    if not is_so:
        raise CheckFailed(text)


@contextmanager
def expect_error(kind: Type[Exception], text: str) -> Iterator[None]:
    """What is inside has to raise ``kind``."""
    try:
        yield
    except kind:
        return
    raise CheckFailed(text)


def run_checks(
    package: str, kits: Mapping[str, CheckSuite], arguments: Optional[Sequence[str]] = None
) -> int:
    """Returns 0 if the plugin does all that is asked, 1 if not, 2 if there is no such plugin."""
    parser = argparse.ArgumentParser(
        prog=f"python3 -m {package}.check",
        description=f"Try a plugin of {package}: does it do what its contract says?",
    )
    parser.add_argument("name", metavar="NAME", help="my_package.my_module/MyClass, or another name it has")
    parser.add_argument("--kind", choices=kits, help="what it is, if it could be several")
    options = parser.parse_args(arguments)
    try:
        subject, checks = _found(options.name, [kits[options.kind]] if options.kind else [*kits.values()])
    except PluginError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    failed = sum(not _passes(subject, check) for check in checks)
    print(f"{options.name}: {len(checks) - failed} of {len(checks)} checks passed")
    return 1 if failed else 0


def _found(name: str, kits: List[CheckSuite]) -> Tuple[Any, Tuple[Check, ...]]:
    """What the checks are made with, and these. Raises PluginError with what it lacks."""
    reasons = []
    for kit in kits:
        try:
            subject = kit.find(name)
        except PluginError as error:
            reasons.append(str(error))
            continue
        if subject is not None:
            return subject, kit.checks
    raise PluginError("\n       ".join(dict.fromkeys(reasons)) or f"there is no plugin {name}")


def _passes(subject: Any, check: Check) -> bool:
    asked = (check.__doc__ or "").strip().splitlines()[0]
    try:
        check(subject)
    except (CheckFailed, PlanarError) as error:
        print(f"FAIL  {asked}\n      {error}")
        return False
    print(f"ok    {asked}")
    return True
