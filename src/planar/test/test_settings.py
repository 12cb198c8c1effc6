from dataclasses import dataclass

import pytest

from planar import SettingsError
from planar.config.hints import nearest_name
from planar.config.settings import check, settings_from


@dataclass(frozen=True)
class Engine:
    cylinders: int = 4
    power: float = 50.0
    fuel: str = "petrol"
    turbo: bool = False

    def __post_init__(self):
        check(self.power > 0, "power", "positive", self.power)


NAMES = {"engine_power": "power"}


def test_official_names_fill_readable_fields_and_the_rest_keeps_its_default():
    engine, unknown = settings_from(Engine, {"engine_power": 70, "cylinders": 6.0}, NAMES)
    assert engine == Engine(cylinders=6, power=70.0)
    assert unknown == []


def test_unknown_names_are_returned():
    assert settings_from(Engine, {"cilinders": 3}, NAMES)[1] == ["cilinders"]
    assert nearest_name("cilinders", ["cylinders", "power"]) == "cylinders"


@pytest.mark.parametrize(
    "values, complaint",
    [
        ({"cylinders": "four"}, "/car/cylinders must be a whole number, got 'four'"),
        ({"turbo": "yes"}, "/car/turbo must be true or false"),
        ({"engine_power": float("nan")}, "/car/engine_power must be a number"),
        ({"engine_power": -1.0}, "/car/engine_power must be positive, got -1.0"),
    ],
)
def test_a_wrong_value_is_refused_under_its_official_name(values, complaint):
    with pytest.raises(SettingsError, match=complaint):
        settings_from(Engine, values, NAMES, where="/car/")


def test_a_value_of_a_wrong_type_can_count_as_not_set():
    complaints = []
    values = {"turbo": "map", "cylinders": 6, "engine_power": "much"}
    engine, unknown = settings_from(Engine, values, NAMES, "/car/", complaints.append)
    assert (engine, unknown) == (Engine(cylinders=6), [])
    assert complaints == [
        "/car/turbo must be true or false, got 'map'",
        "/car/engine_power must be a number, got 'much'",
    ]
