"""Conversion of Python 2 scripts, as used with ROS Kinetic, to Python 3."""

import warnings

from fissix.pgen2.parse import ParseError
from fissix.pgen2.tokenize import TokenError
from fissix.refactor import RefactoringTool, get_fixers_from_package

# Columns of a tab in Python 2.
TAB_WIDTH = 8


def to_python3(source: str) -> str:
    """Convert a script to Python 3; Python 3 and texts that are not Python are returned unchanged."""
    if _is_python3(source):
        return source
    without_tabs = source.expandtabs(TAB_WIDTH)
    if _is_python3(without_tabs):
        return without_tabs
    tool = RefactoringTool(get_fixers_from_package("fissix.fixes"))
    try:
        converted = str(tool.refactor_string(without_tabs.rstrip() + "\n", "script"))
    except (ParseError, TokenError, IndentationError):
        return source
    return converted if _is_python3(converted) else source


def _is_python3(source: str) -> bool:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            compile(source, "script", "exec", dont_inherit=True)
    except (SyntaxError, ValueError):
        return False
    return True
