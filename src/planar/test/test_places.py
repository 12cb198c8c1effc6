import pytest

from planar import Pose2, SettingsError, grid_from_picture
from planar.maps.places import NamedPlace, load_pickup_and_dropoff, load_places, unreachable_reason


def write(folder, text):
    path = folder / "places.yaml"
    path.write_text(text)
    return path


def test_places_are_read_with_defaults(tmp_path):
    places = load_places(write(tmp_path, "a: {x: 1, y: 2.5}\nb: {x: 0, y: 0, yaw: 1.5, radius: 0.2}"))
    assert places == {"a": NamedPlace("a", Pose2(1.0, 2.5)), "b": NamedPlace("b", Pose2(0.0, 0.0, 1.5), 0.2)}


@pytest.mark.parametrize(
    "text, complaint",
    [
        ("a: {x: 1}", "places.yaml:1: a.y is missing"),
        ("a: {x: 1, y: north}", "places.yaml:1: a.y must be a number"),
        ("a: {x: 1, y: .nan}", "places.yaml:1: a.y must be a number"),
        ("a: {x: 1, y: 2, z: 3}", r':1: unknown key "a.z" \(known: x, y, yaw, radius, approaches\)'),
        ("\na: {x: 1, y: 2, radius: 0}", ":2: a.radius must be positive"),
        ("a: {x: 1, y: 2, approaches: [{x: 1}]}", r":1: a.approaches\[1\].y is missing"),
        ("a: 3", ":1: a must be a table of keys and values, got 3"),
        ("- 1", ":1: expected a table"),
        ("a: {", "not valid YAML"),
    ],
)
def test_a_malformed_file_is_refused_naming_file_line_and_key(tmp_path, text, complaint):
    path = write(tmp_path, text)
    with pytest.raises(SettingsError, match=complaint) as caught:
        load_places(path)
    assert str(path) in str(caught.value)


def test_a_missing_file_or_place_is_named(tmp_path):
    with pytest.raises(SettingsError, match="none.yaml: no such file"):
        load_places(tmp_path / "none.yaml")
    with pytest.raises(SettingsError, match="places.yaml: place dropoff is missing"):
        load_pickup_and_dropoff(write(tmp_path, "pickup: {x: 1, y: 2}"))


@pytest.mark.parametrize(
    "x, reason", [(0.5, "obstacle"), (1.5, None), (2.5, "unknown space"), (7.0, "outside the map")]
)
def test_unreachable_places_have_a_reason(x, reason):
    answer = unreachable_reason(NamedPlace("shelf", Pose2(x, 0.5)), grid_from_picture("#.?"))
    assert answer is None if reason is None else ("place shelf" in answer and reason in answer)


def test_a_robot_within_the_radius_is_at_the_place():
    place = NamedPlace("a", Pose2(1.0, 1.0), 0.5)
    assert place.contains(Pose2(1.3, 1.3, 2.0))
    assert not place.contains(Pose2(1.4, 1.4, 0.0))


def test_a_robot_near_any_pose_is_at_the_place():
    place = NamedPlace("a", Pose2(1.0, 1.0), 0.5, (Pose2(3.0, 1.0),))
    assert place.contains(Pose2(3.2, 1.0))
    assert not place.contains(Pose2(2.0, 1.0))


def test_an_approach_in_an_obstacle_makes_a_place_unreachable():
    place = NamedPlace("shelf", Pose2(1.5, 0.5), approaches=(Pose2(0.5, 0.5),))
    assert (
        unreachable_reason(place, grid_from_picture("#.?"))
        == "place shelf (0.5, 0.5) lies in an obstacle of the map"
    )
