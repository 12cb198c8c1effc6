"""Contract checks of global planners."""

from typing import Any

import numpy as np

from move_base_lite.check.maps import PICTURES, CheckMap, check_map
from move_base_lite.costmap import INSCRIBED
from move_base_lite.errors import GoalBlocked, NoPath, OutOfMap
from planar.extensions import Plugin
from planar.extensions.check import expect, expect_error, expect_unchanged, same_results

# Maximum distance of consecutive points [cells].
LONGEST_STEP = 3.0


def finds_paths(plugin: Plugin[Any]) -> None:
    """It finds a collision-free path in small steps from start to goal on every map."""
    for name in PICTURES:
        room = check_map(name)
        window, path_xy = room.costmap.window, _plan(plugin, room)
        expect(np.allclose(path_xy[0], room.start_xy), f"{name}: begins at {path_xy[0]}")
        expect(np.allclose(path_xy[-1], room.goal_xy), f"{name}: ends at {path_xy[-1]}")
        step = np.linalg.norm(np.diff(path_xy, axis=0), axis=1).max()
        expect(step <= LONGEST_STEP * window.resolution, f"{name}: a step of {step:.2f} m")
        costs = [room.costmap.costs[window.cell_of(x, y)] for x, y in path_xy.tolist()]
        expect(max(costs) < INSCRIBED, f"{name}: crosses a cell of cost {max(costs)}")


def changes_nothing(plugin: Plugin[Any]) -> None:
    """It does not modify its arguments."""
    room = check_map("corner")
    with expect_unchanged(costs=room.costmap.costs):
        _plan(plugin, room)


def raises_the_reason(plugin: Plugin[Any]) -> None:
    """Without a path it raises the reason: OutOfMap, GoalBlocked or NoPath."""
    room = check_map("door")
    outside_xy = (room.start_xy[0] - 100.0, room.start_xy[1])
    with expect_error(OutOfMap, "no OutOfMap for a goal 100 m outside"):
        _plan(plugin, CheckMap(room.costmap, room.start_xy, outside_xy))
    in_the_wall_xy = (0.1, 0.1)
    with expect_error(GoalBlocked, "no GoalBlocked for a goal in the wall"):
        _plan(plugin, CheckMap(room.costmap, room.start_xy, in_the_wall_xy))
    middle = room.costmap.costs.shape[1] // 2
    room.costmap.costs[:, middle - 2 : middle + 2] = 254
    with expect_error(NoPath, "no NoPath through a closed door"):
        _plan(plugin, room)


def _plan(plugin: Plugin[Any], room: CheckMap) -> np.ndarray:
    planner = plugin.make(plugin.settings())
    return planner.plan(room.plan_request)


CHECKS = (
    finds_paths,
    same_results(lambda plugin: _plan(plugin, check_map("door"))),
    changes_nothing,
    raises_the_reason,
)
