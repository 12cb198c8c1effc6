import pytest

from map_lite.map_source import parse_arguments, parse_resolution, resolve_map_url
from planar.maps.map_file import MapMissingError


def test_a_map_alone():
    arguments = parse_arguments(["home.yaml"])
    assert (arguments.map, arguments.resolution) == ("home.yaml", None)


@pytest.mark.parametrize(
    ("word", "resolution"),
    [("0.05", 0.05), ("5e-2", 0.05), (".05m", 0.05), ("0", None), ("/map", None), ("-", None)],
)
def test_a_second_argument_is_read_as_far_as_it_is_a_number(word, resolution):
    assert parse_resolution(word) == resolution
    assert parse_arguments(["home.pgm", word]).resolution == resolution


def test_further_arguments_are_refused(capsys):
    with pytest.raises(SystemExit):
        parse_arguments(["home.yaml", "0", "odom"])


def packages(name):
    return {"homes": "/opt/homes"}[name]


@pytest.mark.parametrize(
    "url, path",
    [
        ("/maps/home.yaml", "/maps/home.yaml"),
        ("maps/home.yaml", "maps/home.yaml"),
        ("file:///maps/home.yaml", "/maps/home.yaml"),
        ("package://homes/maps/home.yaml", "/opt/homes/maps/home.yaml"),
    ],
)
def test_paths_and_urls_are_resolved_to_files(url, path):
    assert str(resolve_map_url(url, packages)) == path


def test_an_unknown_package_is_named():
    with pytest.raises(MapMissingError, match="no package castles"):
        resolve_map_url("package://castles/a.yaml", packages)


def test_other_protocols_are_refused():
    with pytest.raises(MapMissingError, match="neither a path"):
        resolve_map_url("https://maps.example/a.yaml", packages)
