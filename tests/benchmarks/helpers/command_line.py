"""Command line options of several benchmarks."""


def seeds(text: str) -> range:
    """Parse "0-9" or "7" into a range. Raises ValueError."""
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)
