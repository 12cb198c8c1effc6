"""Object search: views, posterior, order of looks, and how a search ends."""

import numpy as np
import pytest

from pick_objects import Delivery, Errand, Mission, MissionError, parse_mission
from pick_objects.search import LookForObject, LookTaken, ObjectSearch, SearchArea, search_area_of
from planar import Pose2, SettingsError, grid_from_picture
from planar.driving import FinishTask, GoalFailed, GoalReached
from planar.maps.places import NamedPlace
from planar.maps.semantic_map import FurnitureTop, ObjectPrior, SemanticMap

# Two rooms with a door between them; cells of 0.1 m. The eastern room is far to reach.
ROWS = ["#" * 81]
ROWS += ["#" + "." * 39 + "#" + "." * 39 + "#"] * 30
ROWS += ["#" + "." * 79 + "#"] * 10
ROWS += ["#" * 81]
GRID = grid_from_picture("\n".join(ROWS), 0.1)
START = Pose2(2.0, 0.6)
NEAR = FurnitureTop("table in west", "table", "west", Pose2(1.0, 3.0), (1.0, 0.8), 0.7)
FAR = FurnitureTop("shelf in east", "shelf", "east", Pose2(7.0, 3.5), (1.0, 0.3), 1.8)
ROOMS = {"west": "hall", "east": "office"}


def semantic_map(on=None, tops=(NEAR, FAR)):
    prior = ObjectPrior("cup", on or {"table": 1.0, "shelf": 1.0})
    return SemanticMap(ROOMS, {top.name: top for top in tops}, {"cup": prior})


@pytest.fixture(name="area", scope="module")
def area_():
    return SearchArea(GRID, semantic_map())


def views_of(area, top):
    points = area.top_of_point == top
    return [view for view, row in zip(area.views, area.detection) if row[points].max() > 0.0]


def test_walls_hide_furniture_and_tops_are_seen_from_their_own_room(area):
    assert views_of(area, 0) and all(view.x < 4.0 or view.y < 1.2 for view in views_of(area, 0))
    assert views_of(area, 1) and all(view.x > 4.0 or view.y < 1.2 for view in views_of(area, 1))


def test_views_face_what_they_show_and_the_robot_can_stand_there(area):
    for view, row in zip(area.views, area.detection):
        for x, y in area.points_xy[row > 0.0]:
            at = view.inverse() @ Pose2(x, y)
            assert abs(np.arctan2(at.y, at.x)) <= 0.525 + 1e-9
        assert GRID.value_at(view.x, view.y) == 0


def test_the_posterior_is_bayes_rule(area):
    search = ObjectSearch(area, "cup")
    view = search.next_view(START)
    before, missed = search.mass.copy(), 1.0 - area.detection[view]
    search.on_nothing_seen(view)
    expected = before * missed / (before * missed).sum()
    assert np.allclose(search.mass / search.mass.sum(), expected)
    assert np.isclose(sum(search.posterior().values()), 1.0)


def test_of_equally_likely_places_the_near_one_is_first_and_a_far_likelier_one_can_win():
    even = ObjectSearch(SearchArea(GRID, semantic_map()), "cup")
    assert even.furniture_shown_by(even.next_view(START)) == "table in west"
    biased = ObjectSearch(SearchArea(GRID, semantic_map({"table": 1.0, "shelf": 60.0})), "cup")
    assert biased.furniture_shown_by(biased.next_view(START)) == "shelf in east"


def test_a_search_without_success_ends_after_all_was_looked_at(area):
    search, base = ObjectSearch(area, "cup"), START
    while (view := search.next_view(base)) is not None:
        search.on_nothing_seen(view)
        base = area.views[view]
        assert search.looks < 40
    assert search.names_looked_at() == (["table in west", "shelf in east"], [])


def test_views_that_cannot_be_reached_are_left_out(area):
    search = ObjectSearch(area, "cup")
    while (view := search.next_view(START)) is not None:
        search.on_unreachable(view)
    assert search.names_looked_at() == ([], ["table in west", "shelf in east"])


def test_a_map_without_furniture_is_refused():
    with pytest.raises(SettingsError, match="has no furniture"):
        SearchArea(GRID, semantic_map(tops=()))


@pytest.mark.parametrize("semantics", [None, semantic_map(tops=())])
def test_without_furniture_there_is_nowhere_to_search(semantics):
    """As in a home that was imported from walls alone: its other missions run."""
    assert search_area_of(GRID, semantics) is None


DESK = NamedPlace("desk", Pose2(6.0, 0.6))
FIND, FETCH = Delivery("find", "cup", "", ""), Delivery("fetch", "cup", "", "desk")


def run(area, *deliveries, cup_at, unreachable=(), settings=None):
    """Carry out an errand; a look shows the cup from within 2 m. Return errand, end and drives."""
    mission = Mission("test", {"desk": DESK}, deliveries)
    errand, now, event, drives, at = Errand(mission, area), 0.0, None, [], START
    while True:
        errand.base_in_map = at
        order = errand.advance(now, event)
        now, event = now + 0.5, None
        if isinstance(order, FinishTask):
            return errand, order, drives
        if isinstance(order, LookForObject):
            is_seen = cup_at is not None and at.distance_to(Pose2(*cup_at)) < 2.0
            event = LookTaken(at, cup_at if is_seen else None)
        elif order is not None:
            drives.append(order.place.name)
            event = GoalReached() if order.place.name not in unreachable else GoalFailed("blocked")
            at = order.pose
        assert now < 500.0


def test_an_object_is_found_and_its_furniture_named(area):
    errand, end, _ = run(area, FIND, cup_at=(7.0, 3.5))
    assert end == FinishTask(True, "cup is on shelf in east, at (7.00, 3.50)")
    assert errand.object_locations["cup"].place == "shelf in east"


def test_an_object_is_searched_fetched_and_delivered(area):
    errand, end, drives = run(area, FETCH, cup_at=(1.0, 3.0))
    assert end.success and errand.object_locations["cup"].place == "desk"
    assert drives[0] == "view of table in west" and drives[-2:] == ["cup", "desk"]


def test_a_missing_object_ends_with_what_was_looked_at(area):
    _, end, _ = run(area, FETCH, cup_at=None)
    assert not end.success
    assert "cup was not found in" in end.reason and "table in west, shelf in east" in end.reason


def test_a_room_that_cannot_be_reached_is_named(area):
    _, end, _ = run(area, FIND, cup_at=None, unreachable=("view of shelf in east",))
    assert not end.success and end.reason.endswith("not seen: shelf in east")


def test_an_object_that_was_delivered_is_not_searched_again(area):
    _, end, drives = run(area, FETCH, FIND, cup_at=(1.0, 3.0))
    assert end.success and drives.count("cup") == 1 and "view of shelf in east" not in drives


def test_an_errand_without_a_semantic_map_fails_with_the_reason():
    _, end, _ = run(None, FIND, cup_at=(1.0, 3.0))
    assert not end.success and "no semantic map" in end.reason


def test_searches_are_written_in_mission_files():
    mission = parse_mission(
        "deliveries: [{find: cup}, {object: cup, to: desk}]", {"desk": DESK}, semantic_map=semantic_map()
    )
    assert [str(each) for each in mission.deliveries] == ["find cup", "cup to desk"]
    assert [mission.is_searched(each) for each in mission.deliveries] == [True, False]


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        (
            "{find: cupp}",
            'find cannot be searched: semantic_map.yaml: objects do not list cupp (did you mean "cup"?)',
        ),
        ("{find: cup, to: desk}", 'unknown key "deliveries[1].to"'),
        ("{object: cup, to: dusk}", 'to names no place: dusk (did you mean "desk"?)'),
        ("{object: cup}", "to is missing"),
    ],
)
def test_mistakes_in_searches_are_reported(entry, message):
    with pytest.raises(SettingsError) as error:
        parse_mission(f"deliveries: [{entry}]", {"desk": DESK}, semantic_map=semantic_map())
    assert message in str(error.value)


def test_the_shortest_order_needs_to_know_where_objects_are():
    text = "settings: {order: shortest}\ndeliveries: [{object: cup, to: desk}]"
    with pytest.raises(SettingsError, match="the order shortest needs"):
        parse_mission(text, {"desk": DESK})
    with pytest.raises(MissionError, match="no semantic map"):
        parse_mission("deliveries: [{find: cup}]").check_searches(None)
