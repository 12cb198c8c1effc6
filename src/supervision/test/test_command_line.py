from dataclasses import FrozenInstanceError, dataclass
from pathlib import Path
from typing import Optional, Tuple

import pytest

from supervision.command_line import argument, option, parse


@dataclass(frozen=True)
class Wash:
    """Washes the dishes.

    Not shown by --help.
    """

    dishes: Tuple[Path, ...] = argument("what to wash", type=Path, nargs="+", metavar="DISH")
    hot: bool = option(False, "with hot water")
    dry_with: Optional[str] = option(None, "a cloth", choices=("red", "blue"))
    seconds: float = option(5.0, "for each", type=float)
    known: int = 7


def test_fields_are_options_with_their_defaults():
    assert parse(Wash, ["cup"], "wash.sh") == Wash((Path("cup"),))


def test_what_is_given_takes_the_place_of_defaults():
    words = ["cup", "pan", "--hot", "--dry-with", "red", "--seconds", "2"]
    assert parse(Wash, words, "wash.sh") == Wash((Path("cup"), Path("pan")), True, "red", 2.0)


def test_parsed_options_are_immutable():
    with pytest.raises(FrozenInstanceError):
        parse(Wash, ["cup"], "wash.sh").hot = True


def test_an_unknown_option_ends_the_process_with_the_name_of_the_script(capsys):
    with pytest.raises(SystemExit) as stop:
        parse(Wash, ["cup", "--known", "8"], "wash.sh")
    assert stop.value.code == 2
    assert "wash.sh: error: unrecognized arguments: --known 8" in capsys.readouterr().err


def test_help_shows_the_first_line_and_the_defaults(capsys):
    with pytest.raises(SystemExit):
        parse(Wash, ["--help"], "wash.sh")
    text = capsys.readouterr().out
    assert "Washes the dishes." in text
    assert "for each (default: 5.0)" in text
    assert "Not shown" not in text
    assert "a cloth\n" in text
