"""Contract checks for plugins, run as ``python3 -m PACKAGE.check NAME``.

A check is a function whose docstring states the requirement and that raises CheckFailed with what it found
instead. It is given a plugin of one extension point, behind its guard: so each call also checks the answer,
and that the arguments are not changed. The unit tests apply the same checks to the built-in classes.
"""

import argparse
import sys
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Callable, Iterator, List, Mapping, Optional, Sequence, Tuple, Type

import numpy as np

from planar.errors import PlanarError
from planar.extensions.loading import PluginError
from planar.extensions.point import ExtensionPoint

Check = Callable[[Any], None]


class CheckFailed(Exception):  # noqa: N818  -- reports a fault of the plugin, not of this program
    """A plugin violates its contract; the text describes what it does instead."""


@dataclass(frozen=True)
class CheckSuite:
    """A kind of plugin and its checks.

    Attributes:
        find: Returns the argument of the checks for a plugin's name, or None if there is no such plugin of
            this kind; raises PluginError if the plugin lacks something.
        checks: Functions that raise CheckFailed.
    """

    find: Callable[[str], Any]
    checks: Tuple[Check, ...]


def suite(contract: ExtensionPoint[Any], made_of: Callable[[str], Any], *checks: Check) -> CheckSuite:
    """Return the suite of an extension point.

    Args:
        contract: The extension point.
        made_of: Makes the argument of the checks from the plugin's name.
        checks: Functions that raise CheckFailed.
    """
    return CheckSuite(lambda name: None if contract.load(name) is None else made_of(name), checks)


def same_results(
    run: Callable[[Any], Any], requirement: str = "The same calls give the same results."
) -> Check:
    """Return the check that two runs are equal.

    Args:
        run: Calls the plugin that it is given, and returns arrays or comparable values.
        requirement: Docstring of the check.
    """

    def is_deterministic(plugin: Any) -> None:
        first, second = run(plugin), run(plugin)
        is_equal = np.array_equal(first, second) if isinstance(first, np.ndarray) else first == second
        expect(bool(is_equal), "the second run gave other results")

    is_deterministic.__doc__ = requirement
    return is_deterministic


@contextmanager
def expect_unchanged(**given: np.ndarray) -> Iterator[None]:
    """Check that the block does not write into arrays, named as in the message."""
    before = {name: array.copy() for name, array in given.items()}
    yield
    for name, array in given.items():
        is_equal = np.array_equal(array, before[name], equal_nan=array.dtype.kind == "f")
        expect(is_equal, f"the call modified the {name.replace('_', ' ')}")


def expect(condition: bool, text: str) -> None:
    """Raise CheckFailed with ``text`` unless the condition holds."""
    if not condition:
        raise CheckFailed(text)


@contextmanager
def expect_error(kind: Type[Exception], text: str) -> Iterator[None]:
    """Check that the block raises an exception of type ``kind``."""
    try:
        yield
    except kind:
        return
    raise CheckFailed(text)


def run_checks(
    package: str, suites: Mapping[str, CheckSuite], arguments: Optional[Sequence[str]] = None
) -> int:
    """Run the checks of a plugin and print their results.

    Args:
        package: Name of the package, for the usage message.
        suites: Suites by kind of plugin.
        arguments: Command line; by default that of the process.

    Returns:
        Exit code: 0 if all checks pass, 1 if one fails, 2 if there is no such plugin.
    """
    parser = argparse.ArgumentParser(
        prog=f"python3 -m {package}.check",
        description=f"Check whether a plugin of {package} satisfies its contract.",
    )
    parser.add_argument("name", metavar="NAME", help="my_package.my_module/MyClass or an entry point")
    parser.add_argument("--kind", choices=suites, help="kind of the plugin, if the name fits several")
    options = parser.parse_args(arguments)
    try:
        subject, checks = _found(options.name, [suites[options.kind]] if options.kind else [*suites.values()])
    except PluginError as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    failed = sum(not _passes(subject, check) for check in checks)
    print(f"{options.name}: {len(checks) - failed} of {len(checks)} checks passed")
    return 1 if failed else 0


def _found(name: str, suites: List[CheckSuite]) -> Tuple[Any, Tuple[Check, ...]]:
    """Return the argument of the checks, and the checks. Raises PluginError with what the plugin lacks."""
    reasons = []
    for each in suites:
        try:
            subject = each.find(name)
        except PluginError as error:
            reasons.append(str(error))
            continue
        if subject is not None:
            return subject, each.checks
    raise PluginError("\n       ".join(dict.fromkeys(reasons)) or f"no plugin named {name}")


def _passes(subject: Any, check: Check) -> bool:
    requirement = (check.__doc__ or "").strip().splitlines()[0]
    try:
        check(subject)
    except (CheckFailed, PlanarError) as error:
        print(f"FAIL  {requirement}\n      {error}")
        return False
    print(f"ok    {requirement}")
    return True
