"""Command lines of nodes: a word that is not known is named and left aside, as the official nodes do."""

import argparse
import sys
from typing import List


def parse_known(parser: argparse.ArgumentParser, words: List[str]) -> argparse.Namespace:
    """What the parser knows of the words."""
    known, unknown = parser.parse_known_args(words)
    warn_unknown(parser.prog, unknown)
    return known


def warn_unknown(program: str, words: List[str]) -> None:
    """Says which words mean nothing, if there are any."""
    if words:
        print(f"[{program}] goes on without what it does not know: {' '.join(words)}", file=sys.stderr)
