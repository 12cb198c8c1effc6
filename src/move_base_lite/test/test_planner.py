"""The contract of a global planner, on maps drawn as pictures."""

import numpy as np
import pytest
from scipy.ndimage import label

from move_base_lite import GoalBlocked, NoPath, OutOfMap, StartBlocked
from move_base_lite.check import CHECK_SUITES
from move_base_lite.costmap import INSCRIBED, LETHAL, UNKNOWN, CostmapWindow
from move_base_lite.planning import GLOBAL_PLANNERS, Navfn, NavfnSettings, PlanRequest, path_cost
from move_base_lite.planning.wavefront import (
    FACTOR,
    IMPASSABLE,
    NEUTRAL,
    propagate_wavefront,
    trace_path,
    traversal_costs,
)

PICTURES = {
    "empty": """
#########
#.......#
#.......#
#.......#
#########""",
    "wall with a door": """
#########
#...#...#
#.......#
#...#...#
#########""",
    "two rooms": """
#########
#...#...#
#...#...#
#...#...#
#########""",
    "U": """
###########
#.........#
#..#####..#
#......#..#
#......#..#
#..#####..#
#.........#
###########""",
    "spiral": """
#########
#.......#
#.#####.#
#.#...#.#
#.#.###.#
#.#.....#
#########""",
    "diagonal": """
#######
##....#
#.#...#
#..#..#
#...#.#
#....##
#######""",
    "islands": """
##########
#..#..#..#
#.....#..#
#..##....#
#..#..#..#
##########""",
}


def costs_of(picture):
    meaning = {"#": LETHAL, ".": 0, "i": INSCRIBED, "?": UNKNOWN, "5": 50}
    lines = picture.strip().splitlines()
    return np.array([[meaning[char] for char in line] for line in reversed(lines)], dtype=np.uint8)


def window_of(costs):
    return CostmapWindow(*costs.shape, resolution=0.5, origin_x=-1.0, origin_y=2.0)


def centre(window, cell):
    return window.origin_x + (cell[1] + 0.5) * 0.5, window.origin_y + (cell[0] + 0.5) * 0.5


def assert_is_free(path_xy, costs, window):
    longest_step = np.sqrt(2.0) * 1.5 * window.resolution
    assert np.linalg.norm(np.diff(path_xy, axis=0), axis=1).max(initial=0.0) <= longest_step
    for point in path_xy:
        assert costs[window.cell_of(*point)] < INSCRIBED


@pytest.mark.parametrize("check", CHECK_SUITES["global_planner"].checks, ids=lambda check: check.__name__)
@pytest.mark.parametrize("member", GLOBAL_PLANNERS.members, ids=lambda member: member.short_name)
def test_a_global_planner_keeps_its_contract(member, check):
    check(member)


@pytest.mark.parametrize(
    "how", [{}, {"use_astar": True}, {"any_angle": True}, {"use_grid_path": True}], ids=str
)
@pytest.mark.parametrize("name", PICTURES)
def test_each_free_cell_is_reached_from_each_that_is_connected_to_it(name, how):
    costs = costs_of(PICTURES[name])
    window, planner = window_of(costs), Navfn(NavfnSettings(**how))
    rooms, _ = label(costs == 0)
    free = np.argwhere(costs == 0)
    for start in map(tuple, free):
        for goal in map(tuple, free):
            ends = centre(window, start), centre(window, goal)
            if rooms[start] == rooms[goal]:
                path_xy = planner.plan(PlanRequest(costs, window, *ends))
                assert tuple(path_xy[0]) == ends[0]
                assert tuple(path_xy[-1]) == ends[1]
                assert_is_free(path_xy, costs, window)
            else:
                with pytest.raises(NoPath):
                    planner.plan(PlanRequest(costs, window, *ends))


def test_a_plan_is_neither_longer_nor_more_expensive_than_the_gradient_path():
    rng = np.random.default_rng(5)
    costs = rng.choice([0, 0, 30, 90, 200], (60, 60)).astype(np.uint8)
    window, start, goal = CostmapWindow(60, 60, 1.0), (5, 4), (50, 56)
    potential = propagate_wavefront(
        traversal_costs(costs, True, NEUTRAL, FACTOR, IMPASSABLE - 1), *start, *goal, False
    )
    bare = trace_path(potential, *start, *goal, 0.5)
    ends = centre(window, start), centre(window, goal)
    plan = Navfn(NavfnSettings()).plan(PlanRequest(costs, window, *ends))
    lengths = [np.linalg.norm(np.diff(path, axis=0), axis=1).sum() for path in (plan, bare)]
    assert lengths[0] < lengths[1]
    assert path_cost(costs, window, plan) <= path_cost(costs, window, bare)


def test_the_potential_is_kept_if_it_is_visualized():
    costs, ends = costs_of(PICTURES["two rooms"]), [(1, 1), (3, 3), (3, 7)]
    window = window_of(costs)
    start_xy, reached_xy, shut_xy = (centre(window, cell) for cell in ends)
    planner = Navfn(NavfnSettings(visualize_potential=True))
    planner.plan(PlanRequest(costs, window, start_xy, reached_xy))
    potential = planner.potential
    assert (potential.values[ends[0]], potential.values[ends[1]]) == (0.0, potential.at_goal)
    assert np.isinf(potential.values[costs == LETHAL]).all()
    with pytest.raises(NoPath):
        planner.plan(PlanRequest(costs, window, start_xy, shut_xy))
    assert planner.potential is not potential
    assert np.isinf(planner.potential.at_goal)
    without = Navfn(NavfnSettings())
    without.plan(PlanRequest(costs, window, start_xy, reached_xy))
    assert without.potential is None


@pytest.mark.parametrize("use_astar, excess", [(False, 1.01), (True, 1.03)])
def test_a_path_over_open_ground_is_nearly_straight(use_astar, excess):
    costs = np.zeros((200, 200), dtype=np.uint8)
    planner = Navfn(NavfnSettings(use_astar=use_astar))
    for goal in [(180.5, 20.5), (180.5, 100.5), (150.5, 190.5)]:
        path_xy = planner.plan(PlanRequest(costs, CostmapWindow(200, 200, 1.0), (20.5, 10.5), goal))
        straight = np.hypot(goal[0] - 20.5, goal[1] - 10.5)
        assert np.linalg.norm(np.diff(path_xy, axis=0), axis=1).sum() < excess * straight


def test_at_any_angle_a_path_is_shorter_and_as_cheap():
    rng = np.random.default_rng(3)
    costs = np.zeros((120, 120), dtype=np.uint8)
    for row, col in rng.integers(10, 105, (25, 2)):
        costs[row : row + 6, col : col + 6] = LETHAL
    window, ends = CostmapWindow(120, 120, 0.1), ((0.55, 0.55), (11.45, 10.95))
    plain, any_angle = (
        Navfn(NavfnSettings(any_angle=how)).plan(PlanRequest(costs, window, *ends)) for how in (False, True)
    )
    assert_is_free(any_angle, costs, window)
    plain_length, length = (
        np.linalg.norm(np.diff(path, axis=0), axis=1).sum() for path in (plain, any_angle)
    )
    assert length < plain_length
    assert path_cost(costs, window, any_angle) <= path_cost(costs, window, plain)


def test_a_detour_is_preferred_to_a_path_along_an_obstacle():
    picture = "###########\n#.........#\n#.........#\n#.5555555.#\n#.5#####5.#\n#.5555555.#\n###########"
    costs = costs_of(picture)
    window = window_of(costs)
    ends = centre(window, (3, 1)), centre(window, (3, 9))
    path_xy = Navfn(NavfnSettings()).plan(PlanRequest(costs, window, *ends))
    assert path_xy[:, 1].max() > centre(window, (4, 0))[1]


def test_a_goal_in_an_obstacle_is_refused_with_the_reason():
    costs = costs_of("#####\n#.#i#\n#...#\n#####")
    window, planner = window_of(costs), Navfn(NavfnSettings())
    start = centre(window, (1, 1))
    with pytest.raises(GoalBlocked, match=r"the goal at \(0.25, 3.25\) is in an obstacle"):
        planner.plan(PlanRequest(costs, window, start, centre(window, (2, 2))))
    with pytest.raises(GoalBlocked, match="too close to an obstacle"):
        planner.plan(PlanRequest(costs, window, start, centre(window, (2, 3))))


def test_a_blocked_goal_is_replaced_by_the_nearest_free_cell_within_tolerance():
    costs = costs_of("######\n#..###\n#..###\n######")
    window, planner = window_of(costs), Navfn(NavfnSettings())
    blocked = centre(window, (1, 4))
    path_xy = planner.plan(PlanRequest(costs, window, centre(window, (1, 1)), blocked, tolerance=1.0))
    assert tuple(path_xy[-1]) == centre(window, (1, 2))
    with pytest.raises(GoalBlocked):
        planner.plan(PlanRequest(costs, window, centre(window, (1, 1)), blocked, tolerance=0.9))


def test_a_blocked_start_is_replaced_by_the_nearest_free_cell_or_refused():
    costs = costs_of("#######\n#ii...#\n#######")
    window, planner = window_of(costs), Navfn(NavfnSettings())
    goal = centre(window, (1, 5))
    path_xy = planner.plan(PlanRequest(costs, window, centre(window, (1, 2)), goal))
    assert tuple(path_xy[0]) == centre(window, (1, 2))
    with pytest.raises(StartBlocked, match="the robot at"):
        planner.plan(PlanRequest(costs, window, centre(window, (1, 1)), goal))


def test_a_blocked_end_is_not_replaced_by_an_unreachable_cell():
    costs = costs_of("########\n#.#....#\n########")
    window, planner = window_of(costs), Navfn(NavfnSettings())
    between, beyond, in_the_open = (centre(window, (1, col)) for col in (2, 3, 6))
    path_xy = planner.plan(PlanRequest(costs, window, between, in_the_open))
    assert path_xy[:, 0].min() == between[0]
    assert tuple(planner.plan(PlanRequest(costs, window, in_the_open, between, tolerance=0.5))[-1]) == beyond


@pytest.mark.parametrize("outside", [(-5.0, 2.6), (0.0, 99.0)])
def test_a_position_outside_of_the_map_is_refused(outside):
    costs = costs_of(PICTURES["empty"])
    window, planner = window_of(costs), Navfn(NavfnSettings())
    with pytest.raises(OutOfMap, match="the goal"):
        planner.plan(PlanRequest(costs, window, centre(window, (1, 1)), outside))
    with pytest.raises(OutOfMap, match="the robot"):
        planner.plan(PlanRequest(costs, window, outside, centre(window, (1, 1))))


def test_unknown_space_is_crossed_only_if_allowed():
    costs = costs_of("#######\n#..?..#\n#######")
    window = window_of(costs)
    ends = centre(window, (1, 1)), centre(window, (1, 5))
    assert len(Navfn(NavfnSettings(allow_unknown=True)).plan(PlanRequest(costs, window, *ends)))
    with pytest.raises(NoPath):
        Navfn(NavfnSettings(allow_unknown=False)).plan(PlanRequest(costs, window, *ends))


def test_a_goal_at_the_start_gives_a_plan():
    costs = costs_of(PICTURES["empty"])
    window = window_of(costs)
    here = centre(window, (2, 2))
    path_xy = Navfn(NavfnSettings()).plan(PlanRequest(costs, window, here, here))
    assert path_xy.tolist() == [list(here), list(here)]
