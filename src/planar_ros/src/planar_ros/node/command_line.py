"""Command lines of nodes: a word that is not known is named and left aside, as the official nodes do."""

import argparse
import sys
from typing import List


def understood(parser: argparse.ArgumentParser, words: List[str]) -> argparse.Namespace:
    """What the parser knows of the words."""
    known, unknown = parser.parse_known_args(words)
    go_on_without(parser.prog, unknown)
    return known


def go_on_without(program: str, words: List[str]) -> None:
    """Says which words mean nothing, if there are any."""
    if words:
        print(f"[{program}] goes on without what it does not know: {' '.join(words)}", file=sys.stderr)
