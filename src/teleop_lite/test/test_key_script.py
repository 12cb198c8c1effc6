import pytest

from teleop_lite.key_script import KeyScript, KeyScriptError, KeyStroke, parse


@pytest.mark.parametrize("text", ["i:2.0 j:1.5", "i:2,j:1.5", " i:2.0\n\nj:1.5\n", "i:2. , j:1.50,"])
def test_strokes_are_separated_by_blanks_newlines_or_commas(text):
    assert parse(text) == [KeyStroke("i", 2.0), KeyStroke("j", 1.5)]


def test_a_comma_before_a_colon_is_the_key_for_reversing():
    assert parse("i:1,,:2,k:.5") == [KeyStroke("i", 1.0), KeyStroke(",", 2.0), KeyStroke("k", 0.5)]


def test_a_key_without_a_time_is_a_single_press():
    assert parse("q q i:1") == [KeyStroke("q"), KeyStroke("q"), KeyStroke("i", 1.0)]


@pytest.mark.parametrize(
    "text, wrong", [("i:2 y:1", "y:1"), ("i:-1", "i:-1"), ("i:2s", "i:2s"), ("hello", "hello")]
)
def test_an_invalid_part_is_in_the_message(text, wrong):
    with pytest.raises(KeyScriptError, match=f"'{wrong}' is not a key with a time"):
        parse(text)


def test_strokes_follow_each_other_without_a_gap():
    script = KeyScript(parse("i:0.2 j:0.1"))
    assert [script.keys_at(5.0 + 0.1 * tick) for tick in range(4)] == ["i", "i", "j", ""]
    assert script.is_over


def test_single_presses_take_no_time():
    assert KeyScript(parse("q q i:1")).keys_at(0.0) == "qqi"


def test_late_strokes_start_when_they_arrive():
    script = KeyScript(parse("i:0.1"))
    assert [script.keys_at(0.0), script.keys_at(0.1)] == ["i", ""]
    script.add(parse("j:0.2"))
    assert [script.keys_at(7.0 + 0.1 * tick) for tick in range(3)] == ["j", "j", ""]
