"""Faults in files: a list ``faults``, of which every mistake is told with file, line and key."""

from pathlib import Path
from typing import Callable, Optional, Tuple

from planar import SettingsError
from planar.config.yaml_table import Table, read_table
from sim_bridge.faults.kind import Fault
from sim_bridge.faults.registry import KINDS, kind_named, usual_strength, why_not_of_strength

KEYS = ("kind", "start", "end", "strength", "seed")


def load_faults(path: Path, why_not: Callable[[str], Optional[str]] = lambda _: None) -> Tuple[Fault, ...]:
    """The faults of a file, which may hold other things beside, as a mission. Raises SettingsError.

    ``why_not``: the reason for which a kind cannot be used here; None if it can.
    """
    return faults_from(read_table(path), why_not)


def faults_from(table: Table, why_not: Callable[[str], Optional[str]] = lambda _: None) -> Tuple[Fault, ...]:
    """The faults of a table of a file, as ``load_faults``."""
    return tuple(_fault(entry, why_not) for entry in table.tables("faults"))


def _fault(entry: Table, why_not: Callable[[str], Optional[str]]) -> Fault:
    entry.allow_only(*KEYS)
    name = _kind(entry)
    reason = why_not(name)
    if reason is not None:
        raise entry.complaint("kind", f"cannot be used: {reason}")
    start, end = entry.number("start", 0.0), float("inf")
    entry.check(start >= 0.0, "start", "not negative")
    if "end" in entry:
        end = entry.number("end")
        entry.check(end > start, "end", f"after start ({start:g})")
    strength = entry.number("strength", usual_strength(name))
    expected = why_not_of_strength(name, strength)
    entry.check(expected is None, "strength", expected or "")
    seed = entry.value("seed") or 0
    is_seed = isinstance(seed, int) and not isinstance(seed, bool) and seed >= 0
    entry.check(is_seed, "seed", "a whole number from 0")
    return Fault(name, start, end, strength, seed)


def _kind(entry: Table) -> str:
    """One of ours, or the dotted name of other people's."""
    name = entry.text("kind")
    if "/" not in name:
        return entry.choice("kind", KINDS)
    try:
        kind_named(name)
    except SettingsError as error:
        raise entry.complaint("kind", f"cannot be used: {error}") from None
    return name
