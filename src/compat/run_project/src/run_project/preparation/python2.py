"""Scripts of Kinetic's time are in Python 2: the same in Python 3."""

import warnings

from fissix.pgen2.parse import ParseError
from fissix.pgen2.tokenize import TokenError
from fissix.refactor import RefactoringTool, get_fixers_from_package

# As wide as Python 2 took them.
TAB_WIDTH = 8


def to_python3(source: str) -> str:
    """The source in Python 3; as it is if it is that already, or no Python at all."""
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
