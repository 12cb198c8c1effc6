"""Several mistakes of a file are reported at once."""

import pytest

from planar import SettingsError
from planar.config.error_list import ErrorList, read_each
from planar.config.yaml_table import parse_table


def test_all_errors_are_raised_together_and_once_each():
    table, errors = parse_table("a: x\nb: y\nc: 3", "tea.yaml"), ErrorList()
    assert [errors.read(table.number, key) for key in ("a", "b", "c", "b")] == [None, None, 3.0, None]
    with pytest.raises(SettingsError) as caught:
        errors.raise_all()
    assert str(caught.value).splitlines() == [
        "tea.yaml:1: a must be a number, got 'x'",
        "tea.yaml:2: b must be a number, got 'y'",
    ]


def test_nothing_is_raised_without_an_error():
    assert read_each(str, [1, 2]) == ("1", "2")
    ErrorList().raise_all()
