"""The names of rqt's programs."""

from pathlib import Path

import pytest
import yaml

from cockpit.ros.rqt import TOOLS, chosen
from cockpit.ros.tools import names
from planar import PlanarError


def test_every_name_has_a_tool():
    assert set(TOOLS.values()) <= set(names())


def test_every_program_of_a_tool_has_a_package():
    table = yaml.safe_load((Path(__file__).parents[2] / "compat/packages.yaml").read_text())
    assert set(table["tools"]) == set(TOOLS)


@pytest.mark.parametrize(
    ("program", "arguments", "expected"),
    [
        ("rqt_graph", [], ("graph", ())),
        ("rqt_plot", ["/odom/x", "--empty"], ("plot", ("/odom/x",))),
        ("rqt", [], (None, ())),
        ("gzclient", ["--verbose"], (None, ())),
        ("rqt", ["-s", "rqt_console"], ("console", ())),
    ],
)
def test_a_program_is_the_cockpit_at_its_tool(program, arguments, expected):
    assert chosen(program, arguments) == expected


@pytest.mark.parametrize("arguments", [["-s"], ["--standalone", "rqt_dream"]])
def test_an_unknown_program_is_an_error(arguments):
    with pytest.raises(PlanarError, match="unknown program '"):
        chosen("rqt", arguments)
