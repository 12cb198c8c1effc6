"""The command line of map_server: MAP, or IMAGE and a resolution that is read as C's atof reads it."""

import argparse
import re
from typing import List, Optional

_LEADING_NUMBER = re.compile(r"\s*[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?", re.IGNORECASE)


def resolution_in(word: str) -> Optional[float]:
    """Metres per pixel; None, as without the word, if there is no number in front or if it is 0."""
    number = _LEADING_NUMBER.match(word)
    return (float(number.group()) if number else 0.0) or None


def parse(words: List[str]) -> argparse.Namespace:
    """``map`` and ``resolution``; more words are an error, as in the official one."""
    parser = argparse.ArgumentParser(prog="map_server", description="Serves a map file.")
    parser.add_argument("map", help="YAML file of the map, or (deprecated) its image")
    parser.add_argument(
        "resolution", nargs="?", type=resolution_in, help="metres per pixel, with an image (deprecated)"
    )
    return parser.parse_args(words)
