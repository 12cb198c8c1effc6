"""Faults from YAML files: a list ``faults``, each error with file, line and key."""

from pathlib import Path
from typing import Callable, Optional, Tuple

from planar import SettingsError
from planar.config.error_list import read_each
from planar.config.yaml_table import Table, read_table
from sim_bridge.faults.kind import Fault
from sim_bridge.faults.registry import KINDS, default_strength, kind_named, strength_error

KEYS = ("kind", "start", "end", "strength", "seed")
Check = Callable[[str], Optional[str]]


def load_faults(path: Path, unsupported: Check = lambda _: None) -> Tuple[Fault, ...]:
    """Read the faults of a file, which may have other keys too, as a mission has.

    Args:
        path: YAML file.
        unsupported: Returns why a kind cannot be used here; None if it can.

    Raises:
        SettingsError: With file, line and key.
    """
    return faults_from(read_table(path), unsupported)


def faults_from(table: Table, unsupported: Check = lambda _: None) -> Tuple[Fault, ...]:
    """Read the faults of a YAML table.

    Args:
        table: Table with a list ``faults``; other keys are ignored.
        unsupported: Returns why a kind cannot be used here; None if it can.

    Raises:
        SettingsError: With file, line and key.
    """
    return read_each(lambda entry: _fault(entry, unsupported), table.tables("faults"))


def _fault(entry: Table, unsupported: Check) -> Fault:
    entry.allow_only(*KEYS)
    name = _kind(entry)
    reason = unsupported(name)
    if reason is not None:
        raise entry.error_at("kind", f"cannot be used: {reason}")
    start, end = entry.number("start", 0.0), float("inf")
    entry.check(start >= 0.0, "start", "not negative")
    if "end" in entry:
        end = entry.number("end")
        entry.check(end > start, "end", f"after start ({start:g})")
    strength = entry.number("strength", default_strength(name))
    expected = strength_error(name, strength)
    entry.check(expected is None, "strength", expected or "")
    seed = entry.value("seed") or 0
    is_seed = isinstance(seed, int) and not isinstance(seed, bool) and seed >= 0
    entry.check(is_seed, "seed", "a whole number from 0")
    return Fault(name, start, end, strength, seed)


def _kind(entry: Table) -> str:
    """A kind of the registry, or the dotted name of a user-defined one."""
    name = entry.text("kind")
    if "/" not in name:
        return entry.choice("kind", KINDS)
    try:
        kind_named(name)
    except SettingsError as error:
        raise entry.error_at("kind", f"cannot be used: {error}") from None
    return name
