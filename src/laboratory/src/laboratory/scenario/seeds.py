"""Lists of seeds: ``7``, ``0-999``, ``0-9,20,30-39``."""

from typing import List, Tuple

from planar import SettingsError

MAX_SEEDS = 1_000_000


def parse_seeds(text: str) -> Tuple[int, ...]:
    """Parse a list of seeds, in its order, without duplicates. Raises SettingsError."""
    seeds: List[int] = []
    for part in text.split(","):
        first, dash, last = part.strip().partition("-")
        if not _is_number(first) or (dash and not _is_number(last)):
            raise SettingsError(f"seeds must be like 0-999 or 1,5,7, got {text!r}")
        start, end = int(first), int(last) if dash else int(first)
        if end < start or len(seeds) + end - start >= MAX_SEEDS:
            raise SettingsError(f"seeds must be like 0-999, at most {MAX_SEEDS} of them, got {text!r}")
        seeds.extend(range(start, end + 1))
    return tuple(dict.fromkeys(seeds))


def _is_number(text: str) -> bool:
    return text.isascii() and text.isdigit() and len(text) < 10
