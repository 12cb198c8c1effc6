import pytest

from map_lite.map_url import path_of
from planar.maps.map_file import MapMissingError


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
def test_paths_and_urls_name_files(url, path):
    assert str(path_of(url, packages)) == path


def test_an_unknown_package_is_named():
    with pytest.raises(MapMissingError, match="no package castles"):
        path_of("package://castles/a.yaml", packages)


def test_other_protocols_are_refused():
    with pytest.raises(MapMissingError, match="neither a path"):
        path_of("https://maps.example/a.yaml", packages)
