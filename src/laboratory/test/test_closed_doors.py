"""Doors of scenarios: which ones close, that an alternative path remains, and that the robot takes it."""

import math
from dataclasses import replace

import numpy as np
import pytest

from laboratory.generators.offices import Offices
from laboratory.runner import run_scenario
from laboratory.scenario import read_scenario
from laboratory.suites import FOLDER
from laboratory.tasks.shortest_paths import PASSAGE_CLEARANCE, ShortestPaths
from planar import Pose2, SettingsError
from sim_bridge.simulation import box_on_floor
from sim_bridge.views.true_map import true_map

SCENARIO = FOLDER / "home_doors.yaml"
OFFICES = FOLDER / "office_doors.yaml"


def written(tmp_path, doors):
    path = tmp_path / "scenario.yaml"
    text = SCENARIO.read_text().replace("../map", str(FOLDER.parent / "map"))
    begin = text.index("  doors:")
    path.write_text(text[:begin] + f"  doors: {doors}\n")
    return path


def map_with_closed_doors(arena):
    """The true map of a world with its doors as walls."""
    doors = arena.world.doors
    walls = [box_on_floor(f"wall_for_{door.name}", (0.06, door.width, 1.0), door.pose) for door in doors]
    return true_map(replace(arena.world, bodies=(*arena.world.bodies, *walls)))


def test_the_robot_takes_the_alternative_path_if_a_door_is_closed():
    scenario = read_scenario(SCENARIO)
    shut, usual = run_scenario(scenario, 3), run_scenario(replace(scenario, doors=0), 3)
    assert shut.is_success, shut.reason
    assert shut.driven > 1.8 * usual.driven
    assert replace(run_scenario(scenario, 3), wall_seconds=0.0) == replace(shut, wall_seconds=0.0)


def test_the_door_of_the_suite_closes_the_shortest_path_but_not_all():
    arena = read_scenario(SCENARIO).arena(0)
    ends = (Pose2(), Pose2(2.0, 3.0))
    grids = (arena.grid, map_with_closed_doors(arena))
    nearest, other = (ShortestPaths(grid, PASSAGE_CLEARANCE).length(ends) for grid in grids)
    assert nearest is not None and other is not None and other > 2.0 * nearest


def test_closed_doors_of_a_generated_office_leave_every_place_reachable():
    scenario = read_scenario(OFFICES)
    shut = 0
    for seed in range(6):
        arena = scenario.arena(seed)
        doors, places = arena.world.doors, [Pose2(), *scenario.task.required_poses(arena)]
        shut += len(doors)
        assert len(doors) <= 4 and len({door.name for door in doors}) == len(doors)
        assert ShortestPaths(map_with_closed_doors(arena), 0.3).length(places) is not None
        again = replace(scenario, name="again").arena(seed)
        assert again.world.doors == doors
    assert shut > 12


def test_doorways_are_gaps_in_walls():
    arena = Offices(120.0, 160.0).arena(2)
    for door in arena.doorways:
        side = np.array((-math.sin(door.pose.yaw), math.cos(door.pose.yaw))) * (door.width / 2.0 + 0.1)
        middle = np.array((door.pose.x, door.pose.y))
        values = [arena.grid.cells[tuple(cell)] for cell in arena.grid.cells_of([middle, middle + side])]
        assert values[0] == 0 and values[1] == 100


def test_closing_doors_of_a_world_without_doorways_is_an_error(tmp_path):
    result = run_scenario(read_scenario(written(tmp_path, "2")), 0)
    assert result.outcome == "error"
    assert result.reason == "home: doors need a generated building or a list of poses"


@pytest.mark.parametrize(
    ("doors", "complaint"),
    [
        ("-1", ":5: happens.doors must be"),
        ("many", ":5: happens.doors must be"),
        ("[{x: 1, y: 2}]", ":5: happens.doors[1].width is missing"),
        ("[{x: 1, y: 2, width: 0}]", ":5: happens.doors[1].width must be positive"),
        ("[{x: 1, y: 2, width: 1, shut: 3}]", ':5: unknown key "happens.doors[1].shut" (known: '),
        ("[{x: 1, y: 2, width: 1, start: 5, end: 4}]", ":5: happens.doors[1].end must be after start (5)"),
        ("[{x: 1, y: 2, width: 1, start: -5}]", ":5: happens.doors[1].start must be not negative"),
    ],
)
def test_an_error_names_line_and_key(tmp_path, doors, complaint):
    with pytest.raises(SettingsError) as caught:
        read_scenario(written(tmp_path, doors))
    assert complaint in str(caught.value)
