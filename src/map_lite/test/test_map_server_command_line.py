import pytest

from map_lite.command_line import parse, resolution_in


def test_a_map_alone():
    arguments = parse(["home.yaml"])
    assert (arguments.map, arguments.resolution) == ("home.yaml", None)


@pytest.mark.parametrize(
    ("word", "resolution"),
    [("0.05", 0.05), ("5e-2", 0.05), (".05m", 0.05), ("0", None), ("/map", None), ("-", None)],
)
def test_a_second_word_counts_as_far_as_it_is_a_number(word, resolution):
    assert resolution_in(word) == resolution
    assert parse(["home.pgm", word]).resolution == resolution


def test_more_words_are_refused(capsys):
    with pytest.raises(SystemExit):
        parse(["home.yaml", "0", "odom"])
