"""The option --home: the parts of a command that come from the folder of a home."""

from dataclasses import dataclass, replace

import pytest

from evaluation.options import HOME_MAP, GraphOptions, MissionOptions
from planar import SettingsError
from planar.maps.home_folder import manifest_text
from supervision.command_line import parse, words


@dataclass(frozen=True)
class MissionCommand(GraphOptions, MissionOptions):
    """A command that takes all parts of a home."""


@pytest.fixture(name="home")
def home_(tmp_path):
    contents = {
        name: name.encode() for name in ("home.world", "home.yaml", "home.pgm", "zones.yaml", "mission.yaml")
    }
    for name, content in contents.items():
        (tmp_path / name).write_bytes(content)
    (tmp_path / "manifest.yaml").write_text(manifest_text("test", contents))
    return tmp_path


def command(*arguments) -> MissionCommand:
    return parse(MissionCommand, [str(each) for each in arguments], "command")


def test_world_map_zones_and_mission_are_those_of_the_home(home):
    given = command("--home", home)
    parts = (given.world, given.map, given.zones, given.mission)
    assert parts == tuple(home / name for name in ("home.world", "home.yaml", "zones.yaml", "mission.yaml"))
    assert not given.lacks_map


def test_the_navigation_zones_of_the_home_go_to_move_base(home):
    assert "navigation_zones_file" not in command("--home", home).files()
    contents = {path.name: path.read_bytes() for path in home.iterdir() if path.name != "manifest.yaml"}
    (home / "navigation_zones.yaml").write_bytes(b"zones")
    (home / "manifest.yaml").write_text(
        manifest_text("test", {**contents, "navigation_zones.yaml": b"zones"})
    )
    assert command("--home", home).files()["navigation_zones_file"] == home / "navigation_zones.yaml"


def test_a_part_that_is_given_precedes_that_of_the_home(home, tmp_path):
    given = command("--home", home, "--mission", "other.yaml", "--map", "slam.yaml")
    assert (given.mission.name, given.map.name, given.zones) == (
        "other.yaml",
        "slam.yaml",
        home / "zones.yaml",
    )


def test_another_world_does_not_belong_to_the_home(home):
    with pytest.raises(SettingsError, match="--world: other.world does not belong to the home"):
        command("--home", home, "--world", "other.world")


def test_without_a_home_nothing_changes():
    assert command().map is HOME_MAP
    assert command().mission is None


def test_copies_and_command_lines_of_the_options_keep_the_home(home):
    given = command("--home", home)
    assert replace(given, seed=3).world == given.world
    assert command(*words(given)).world == given.world.resolve()


def test_a_stale_home_is_refused_before_anything_starts(home):
    (home / "home.world").write_text("changed")
    with pytest.raises(SettingsError, match="home.world: was changed after home.pgm was rendered"):
        command("--home", home)
