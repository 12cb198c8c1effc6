from dataclasses import dataclass

import yaml

from planar.config.config_file import Section, render_yaml
from planar.config.parameters import POSITIVE, Parameter, check_parameters, parameter


@dataclass(frozen=True)
class Tea:
    minutes: float = parameter(3.0, "how long it draws", "min", POSITIVE, name="draw_time")
    kind: str = parameter("green", "what is brewed", choices=("green", "black"))
    milk: bool = parameter(False, "", heading="For some.")
    pot: str = parameter("", "the file of the pot", required="a path")

    def __post_init__(self):
        check_parameters(self)


@dataclass(frozen=True)
class BlackTea(Tea):
    kind: str = "black"


FILE = Section("", Tea, about="Tea.")


def test_a_file_lists_name_default_unit_and_meaning():
    assert render_yaml(FILE) == (
        "# Tea.\n"
        "draw_time: 3.0  # [min] how long it draws\n"
        "kind: green     # what is brewed: green, black\n"
        "\n"
        "# For some.\n"
        "milk: false\n"
        "# pot        # required: the file of the pot\n"
    )


def test_a_subclass_changes_a_default_and_inherits_the_rest():
    assert "\nkind: black     # what is brewed: green, black\n" in render_yaml(Section("", BlackTea))


def test_sections_nest_repeat_others_and_use_values_of_instances():
    cups = Parameter("cups", [{"size": 0.2}, {"size": 1e-5}], "all of them")
    hut = Section("hut", Section("stove", BlackTea(pot="kettle", minutes=9.0), about="hot"), cups)
    house = Section("", hut, Section("shed", same_as="hut"))
    hut_in_file = {"stove": {"draw_time": 9.0, "kind": "black", "milk": False}}
    hut_in_file["cups"] = [{"size": 0.2}, {"size": 1e-5}]
    assert yaml.safe_load(render_yaml(house)) == {"hut": hut_in_file, "shed": hut_in_file}


def test_a_long_meaning_continues_on_the_next_line():
    lines = render_yaml(Section("", Parameter("cup", 1, "word " * 40))).splitlines()
    assert len(lines) == 2 and lines[1].startswith("        # word") and len(lines[0]) <= 110
