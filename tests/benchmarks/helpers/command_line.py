"""What several benchmarks are told."""


def seeds(text: str) -> range:
    """Those of "0-9", or of "7" alone. Raises ValueError."""
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)
