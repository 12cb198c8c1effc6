import time
from pathlib import Path

import pytest

from planar import PlanarError, SettingsError
from planar.config.yaml_table import parse_table, read_table

TEXT = """\
name: tea
count: 3
share: 1e-3
nested:
  pose: [1, 2.5, -3]
  tags: [a, b]
items:
  - {x: 1}
  - {x: two}
empty:
"""


@pytest.fixture
def table():
    return parse_table(TEXT, "tea.yaml")


def test_values_have_the_requested_type(table):
    assert (table.text("name"), table.count("count"), table.number("share")) == ("tea", 3, 0.001)
    assert table.table("nested").numbers("pose", "x, y, yaw") == (1.0, 2.5, -3.0)
    assert table.table("nested").texts("tags") == ["a", "b"]
    assert [item.name for item in table.tables("items")] == ["items[1]", "items[2]"]


def test_paths_are_relative_to_a_folder(tmp_path):
    table = parse_table("near: a/../b.yaml\nfar: /tmp/x\nown: ~/x", "tea.yaml")
    assert table.path("near", tmp_path) == tmp_path.resolve() / "b.yaml"
    assert table.path("far", tmp_path) == Path("/tmp/x").resolve()
    assert table.path("own", tmp_path) == Path("~/x").expanduser().resolve()


@pytest.mark.parametrize("name", ["~nobody_of_that_name/x", '"a\\0b"'])
def test_an_invalid_path_is_reported_with_its_line(tmp_path, name):
    table = parse_table(f"\nworld: {name}", "tea.yaml")
    with pytest.raises(SettingsError, match="tea.yaml:2: world is not a valid path"):
        table.path("world", tmp_path)


def test_keys_and_dates_are_texts():
    table = parse_table(
        "day: 2020-01-01\nnested: {at: 2001-12-14t21:59:43.10-05:00, 1: [{2: 3}]}", "tea.yaml"
    )
    assert table.values() == {
        "day": "2020-01-01",
        "nested": {"at": "2001-12-14t21:59:43.10-05:00", "1": [{"2": 3}]},
    }


@pytest.mark.parametrize("value", ["!!binary aGk=", "!!set {a}", "!!timestamp 2020-01-01", "!!omap [a: 1]"])
def test_types_beyond_json_are_refused(value):
    table = parse_table(f"ok: 1\nnested: {{much: {value}}}", "tea.yaml")
    with pytest.raises(SettingsError, match="tea.yaml:2: nested cannot be parsed .could not determine a"):
        table.values()


def test_missing_and_empty_values_have_their_defaults(table):
    assert table.number("empty", 7.0) == 7.0
    assert table.text("nothing", "x") == "x"
    assert table.tables("nothing") == table.texts("nothing") == []
    assert "empty" not in table


@pytest.mark.parametrize(
    "read, complaint",
    [
        (lambda t: t.number("name"), "tea.yaml:1: name must be a number, got 'tea'"),
        (lambda t: t.count("share"), "tea.yaml:3: share must be a whole number from 1"),
        (lambda t: t.flag("count"), "tea.yaml:2: count must be true or false, got 3"),
        (lambda t: t.text("nested"), "tea.yaml:4: nested must be a text"),
        (lambda t: t.choice("name", ("milk", "ale")), "tea.yaml:1: name must be one of milk, ale, got 'tea'"),
        (lambda t: t.table("count"), "tea.yaml:2: count must be a table"),
        (lambda t: t.tables("nested"), "tea.yaml:4: nested must be a list of tables"),
        (lambda t: t.table("nested").tables("tags"), r"tea.yaml:6: nested.tags\[1\] must be a table"),
        (lambda t: t.table("nested").number("x"), "tea.yaml:5: nested.x is missing"),
        (lambda t: t.table("nested").numbers("pose", "x, y"), r"tea.yaml:5: nested.pose must be \[x, y\]"),
        (lambda t: t.tables("items")[1].number("x"), r"tea.yaml:9: items\[2\].x must be a number"),
        (lambda t: t.text("empty"), "tea.yaml:10: empty is missing"),
        (lambda t: t.allow_only("nam", "count"), r'tea.yaml:1: unknown key "name" \(did you mean "nam"\?\)'),
    ],
)
def test_an_invalid_value_is_reported_with_file_line_and_key(table, read, complaint):
    with pytest.raises(SettingsError, match=complaint):
        read(table)


@pytest.mark.parametrize(
    "text, complaint",
    [
        ("a: 1\nb: 2\na: 3", 'x:3: duplicate key "a", first in line 1'),
        ("a: {b: 1,\n b: 2}", 'x:2: duplicate key "b"'),
        ("a: [", "x:1: not valid YAML"),
        ("- 1", "x:1: expected a table"),
        ("", "x:1: expected a table"),
        ("? [1, 2]\n: 3", "x:1: keys must be texts"),
        ("<<: 3", "x:1: '<<' must merge a table"),
        ("a: " + "[" * 5000, "not valid YAML"),
        ("a: !!float x", "x:1: a cannot be parsed"),
        ("a: !!python/name:os.system", "x:1: a cannot be parsed"),
    ],
)
def test_invalid_yaml_is_refused(text, complaint):
    with pytest.raises(SettingsError, match=complaint):
        parse_table(text, "x").table("a")


def doubling(first, following, levels=40):
    """A text of a few hundred bytes whose value ``k`` is 2 ** levels times as large as its first one."""
    lines = [f"k0: &k0 {first}"]
    lines += [f"k{i}: &k{i} {following.format(f'*k{i - 1}')}" for i in range(1, levels)]
    return "\n".join([*lines, f"k: {following.format(f'*k{levels - 1}')}"])


@pytest.mark.parametrize(
    "text, complaint",
    [
        (doubling("{a: 1}", "{{<<: [{0}, {0}]}}"), "larger than 2 MB with all aliases"),
        (doubling("[a]", "[{0}, {0}]"), "larger than 2 MB with all aliases"),
        (doubling("{a: 1}", "{{a: {0}, b: {0}}}"), "larger than 2 MB with all aliases"),
        ("k0: &k0 " + "x" * 100_000 + "\nk: [" + ", ".join(["*k0"] * 100) + "]", "larger than 2 MB"),
        ("k: [" + "1," * 500_000 + "]", "x:1: not valid YAML .larger than 2 MB"),
        ("k: &k [*k]", "x:1: not valid YAML .found an alias of what contains it"),
        ("k: &k {<<: *k}", "x:1: not valid YAML .found an alias of what contains it"),
        ("k: " + "[" * 200 + "]" * 200, "x:1: not valid YAML .nested too deeply"),
        ("k: 1" + ":1" * 100_000, "x:1: k cannot be parsed .number of more than 400 characters"),
        ("k: 0x" + "f" * 100_000, "x:1: k cannot be parsed .number of more than 400 characters"),
        ("k: 1" + ":1" * 100_000 + ".0", "x:1: k cannot be parsed .number of more than 400 characters"),
        ("k: " + "x" * (2 << 20), "x: larger than 1 MB"),
    ],
    ids=range(12),
)
def test_a_text_that_would_take_long_is_refused_at_once(text, complaint):
    start = time.process_time()
    with pytest.raises(SettingsError, match=complaint) as caught:
        parse_table(text, "x").number("k")
    assert len(str(caught.value)) < 1000
    assert time.process_time() - start < 10.0


def test_a_long_value_is_shortened_in_a_message():
    with pytest.raises(SettingsError) as caught:
        parse_table("k: " + "x" * 100_000, "x").number("k")
    assert str(caught.value) == f"x:1: k must be a number, got '{'x' * 199}..."


def test_aliases_of_small_values_may_be_many():
    table = parse_table("a: &a {x: 1}\nb: [" + ", ".join(["*a"] * 10_000) + "]", "x")
    assert table.value("b") == [{"x": 1}] * 10_000


def test_every_unknown_key_of_a_table_is_reported():
    with pytest.raises(SettingsError) as caught:
        parse_table("name: x\ncuont: 1\nmuch: 2", "tea.yaml").allow_only("name", "count")
    assert str(caught.value).splitlines() == [
        'tea.yaml:2: unknown key "cuont" (did you mean "count"?)',
        'tea.yaml:3: unknown key "much" (known: name, count)',
    ]


def test_merged_tables_are_one_and_own_keys_win():
    table = parse_table("a: &a {x: 1, y: 2}\nb: {<<: *a, y: 3}", "x")
    assert table.values() == {"a": {"x": 1, "y": 2}, "b": {"x": 1, "y": 3}}
    assert table.table("b").number("y") == 3.0


def test_the_caller_chooses_the_class_of_the_errors(tmp_path):
    class MissingError(PlanarError):
        pass

    with pytest.raises(MissingError, match="none.yaml: no such file"):
        read_table(tmp_path / "none.yaml", missing=MissingError)
    with pytest.raises(SettingsError, match="cannot be read"):
        read_table(tmp_path)
