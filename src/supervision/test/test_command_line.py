from dataclasses import FrozenInstanceError, dataclass
from pathlib import Path
from typing import Optional, Tuple

import pytest

from supervision.command_line import ROOT, argument, option, parse, usage


@dataclass(frozen=True)
class Wash:
    """Washes the dishes.

    They are dried as well.

    Attributes:
        known: Not an option.
    """

    dishes: Tuple[Path, ...] = argument("what to wash", type=Path, nargs="+", metavar="DISH")
    hot: bool = option(False, "with hot water")
    dry_with: Optional[str] = option(None, "a cloth", choices=("red", "blue"))
    seconds: float = option(5.0, "for each, 5 % more if needed", type=float)
    rack: Path = option(ROOT / "src/rack", "where to", type=Path)
    known: int = 7


@dataclass(frozen=True)
class WashTwice(Wash):
    """Washes the dishes twice."""

    twice: bool = option(False, "again")


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


def test_the_usage_shows_description_placeholders_and_defaults():
    assert usage(Wash, "wash.sh") == (
        "usage: wash.sh DISH... [options]\n"
        "\n"
        "Washes the dishes.\n"
        "\n"
        "They are dried as well.\n"
        "\n"
        "arguments:\n"
        "  DISH              what to wash\n"
        "\n"
        "options:\n"
        "  --hot             with hot water\n"
        "  --dry-with red|blue\n"
        "                    a cloth\n"
        "  --seconds N       for each, 5 % more if needed (default: 5)\n"
        "  --rack FILE       where to (default: src/rack)\n"
        "  -h, --help        print this text\n"
    )


def test_options_of_a_class_precede_those_that_it_inherits():
    text = usage(WashTwice, "wash.sh")
    assert text.index("--twice") < text.index("--hot")


def test_help_is_the_usage(capsys):
    with pytest.raises(SystemExit):
        parse(Wash, ["--help"], "wash.sh")
    assert capsys.readouterr().out == usage(Wash, "wash.sh")


@dataclass(frozen=True)
class Dry:
    """Dries the dishes."""

    dishes: Tuple[str, ...] = argument("what to dry", default=(), nargs="*", metavar="DISH")
    quick: bool = option(False, "not wholly")


def test_options_may_stand_between_arguments():
    assert parse(Dry, ["cup", "--quick", "pan"], "dry.sh") == Dry(("cup", "pan"), True)
    assert parse(Dry, [], "dry.sh") == Dry()


def test_help_lists_arguments_between_which_options_may_stand(capsys):
    with pytest.raises(SystemExit):
        parse(Dry, ["cup", "--help"], "dry.sh")
    assert "  DISH        what to dry\n" in capsys.readouterr().out
