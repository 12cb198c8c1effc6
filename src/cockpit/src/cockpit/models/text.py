"""Messages as text of bounded length."""

from typing import Any, Dict, List

import numpy as np

from cockpit.models.tables import preformatted

MOST_LINES, MOST_ITEMS, LONGEST = 60, 8, 120


def outline(message: Any) -> str:
    """Format a message's fields as HTML, with the first items of long arrays."""
    return preformatted("\n".join(lines_of(message)))


def lines_of(message: Any, indent: str = "") -> List[str]:
    """Return the fields as at most MOST_LINES lines."""
    lines: List[str] = []
    for name in message.__slots__:
        if name.startswith("_"):
            continue
        value = getattr(message, name)
        if hasattr(value, "__slots__") and not hasattr(value, "to_sec"):
            lines += [f"{indent}{name}:", *lines_of(value, indent + "  ")]
        elif isinstance(value, (list, tuple, np.ndarray)) and len(value) and hasattr(value[0], "__slots__"):
            lines += [f"{indent}{name}: {len(value)} of", *lines_of(value[0], indent + "  ")]
        else:
            lines.append(f"{indent}{name}: {value_text(value)}")
        if len(lines) >= MOST_LINES:
            return [*lines[: MOST_LINES - 1], f"{indent}..."]
    return lines


def value_text(value: Any) -> str:
    if hasattr(value, "to_sec"):
        return f"{value.to_sec():.3f}"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, bytes):
        return f"{len(value)} bytes"
    if isinstance(value, (list, tuple, np.ndarray)):
        text = ", ".join(value_text(item) for item in value[:MOST_ITEMS])
        return f"[{text}]" if len(value) <= MOST_ITEMS else f"{len(value)} of [{text}, ...]"
    text = str(value)
    return text if len(text) <= LONGEST else text[:LONGEST] + "..."


def flat(tree: Any, name: str = "") -> Dict[str, Any]:
    """Flatten nested dictionaries to their leaves by full name."""
    if not isinstance(tree, dict) or not tree:
        return {name: tree} if name else {}
    return {path: leaf for key, below in tree.items() for path, leaf in flat(below, f"{name}/{key}").items()}


def amount(size: int) -> str:
    """Format a number of bytes."""
    return f"{size / 1e6:.1f} MB" if size >= 100_000 else f"{size / 1e3:.1f} KB"
