"""Importers: plans from maps, pictures, drawings and worlds."""

import math
from pathlib import Path

import numpy as np
import pytest
from made_drawings import draw_floor_plan, dxf_of, ifc_of
from PIL import Image
from scipy.spatial import cKDTree

from home_builder import HomePlan, Opening, Wall, build_home
from home_builder.errors import ImportPlanError
from home_builder.imports import import_plan
from home_builder.imports.maps import plan_of_map
from home_builder.plan.geometry import room_faces
from home_builder.source import folder_of, read_source
from planar import OCCUPIED, OccupancyGrid, PlanarError, Pose2, load_map

MAP = Path(__file__).resolve().parents[3] / "map"
# Two rooms of 4 x 5 m with a door of 0.9 m and a window of 1.5 m.
WALLS = (
    Wall((0.0, 0.0), (8.0, 0.0), 0.2, openings=(Opening("window", 6.0, 1.5, 0.9, 2.1),)),
    Wall((8.0, 0.0), (8.0, 5.0), 0.2),
    Wall((8.0, 5.0), (0.0, 5.0), 0.2),
    Wall((0.0, 5.0), (0.0, 0.0), 0.2),
    Wall((4.0, 0.0), (4.0, 5.0), 0.1, openings=(Opening("door", 2.0, 0.9),)),
)


def openings(plan: HomePlan):
    found = [
        (each.kind, *(round(value, 1) for value in wall.point_at(each.at)), round(each.width, 1))
        for wall in plan.walls
        for each in wall.openings
    ]
    return sorted(found)


def rooms(plan: HomePlan):
    return [round(face.polygon.area, 1) for face in room_faces(plan)]


def overlap(grid: OccupancyGrid, other: OccupancyGrid, shift=(0.0, 0.0)) -> float:
    """Smaller share of the occupied cells of one map that have one of the other within a cell."""
    one_xy, other_xy = (each.points_of(np.argwhere(each.cells == OCCUPIED)) for each in (grid, other))
    reach, other_xy = 1.5 * grid.resolution, other_xy + shift
    nearest = [cKDTree(a).query(b, p=np.inf)[0] for a, b in ((other_xy, one_xy), (one_xy, other_xy))]
    return min(float((distances <= reach).mean()) for distances in nearest)


def round_trip(plan: HomePlan, folder: Path) -> OccupancyGrid:
    build_home(plan, folder)
    return load_map(folder / "home.yaml")


def test_a_map_of_slam_becomes_a_world_with_the_same_map(tmp_path):
    grid = load_map(MAP / "home.yaml")
    plan = import_plan(MAP / "home.yaml")
    assert overlap(grid, round_trip(plan, tmp_path / "home"), plan.start) > 0.98
    assert len(rooms(plan)) >= 6


@pytest.mark.parametrize("degrees", [0.0, 17.0, 45.0, 88.5])
def test_walls_of_any_direction_are_found_in_a_map(degrees, tmp_path):
    build_home(HomePlan(walls=WALLS, start=(2.0, 2.0)), tmp_path / "drawn")
    drawn = load_map(tmp_path / "drawn/home.yaml")
    image = Image.fromarray(np.flipud(drawn.cells).astype(np.uint8))
    turned = np.flipud(np.asarray(image.rotate(degrees, expand=True, fillcolor=0)) == OCCUPIED)
    grid = OccupancyGrid(np.where(turned, OCCUPIED, 0).astype(np.int8), 0.05, Pose2(-3.0, -2.0))
    plan = plan_of_map(grid, "turned")
    long = [wall for wall in plan.walls if wall.length > 3.0]
    assert len(long) >= 5
    errors = [math.sin(2.0 * (wall.yaw - math.radians(degrees))) for wall in long]
    assert max(map(abs, errors)) < math.sin(2.0 * math.radians(1.0))
    assert overlap(grid, round_trip(plan, tmp_path / "again"), plan.start) > 0.97
    doors = [each.width for wall in plan.walls for each in wall.openings]
    assert [width for width in doors if 0.8 <= width <= 1.05]


def test_a_map_with_an_inclined_origin_in_part_of_a_cell_is_shifted_by_less_than_a_cell():
    cells = np.zeros((60, 60), dtype=np.int8)
    cells[[0, -1]] = cells[:, [0, -1]] = OCCUPIED
    plan = plan_of_map(OccupancyGrid(cells, 0.05, Pose2(-1.013, -1.47)), "room")
    assert plan.start == (0.0, 0.0)
    xs = [x for wall in plan.walls for x, _ in (wall.start, wall.end)]
    assert min(xs) == pytest.approx(-1.013 + 0.025, abs=0.05)


def test_a_picture_of_a_floor_plan_becomes_walls_a_door_and_a_window(tmp_path):
    draw_floor_plan(tmp_path / "plan.png")
    plan = import_plan(tmp_path / "plan.png", 0.01)
    assert openings(plan) == [("door", 5.0, 3.0, 0.9), ("window", 7.0, 1.0, 1.5)]
    assert rooms(plan) == pytest.approx([18.5, 18.5], abs=0.3)
    assert plan.furniture == ()
    build_home(plan, tmp_path / "home")


@pytest.mark.parametrize(
    ("pixels", "scale", "complaint"),
    [
        (np.full((50, 50), 200), 0.01, "shows no plan"),
        (np.zeros((50, 50)), 0.01, "shows no plan"),
        (np.where(np.arange(2500).reshape(50, 50) % 50 < 45, 0, 255), 0.01, "90% of it are dark"),
        (np.full((50, 50), 200), 0.0, "--scale: must be the size of a pixel"),
        (np.full((50, 50), 200), float("nan"), "--scale: must be the size of a pixel"),
        (np.full((8000, 8000), 200), 0.01, "8000 x 8000 pixels are more than 60 million"),
    ],
)
def test_a_picture_without_a_plan_is_refused_in_a_sentence(pixels, scale, complaint, tmp_path):
    Image.fromarray(pixels.astype(np.uint8)).save(tmp_path / "plan.png")
    with pytest.raises(ImportPlanError, match=complaint):
        import_plan(tmp_path / "plan.png", scale)


def test_a_world_becomes_walls_with_doors_and_furniture_with_names():
    plan = import_plan(MAP / "home.world")
    assert [round(wall.length, 2) for wall in plan.walls[:4]] == [12.0, 12.0, 10.0, 10.0]
    assert len([each for each in openings(plan) if each[0] == "door" and each[3] == 0.9]) == 8
    assert len(rooms(plan)) == 7
    assert {"bed", "sofa", "desk"} <= {piece.name for piece in plan.furniture}


def test_a_home_is_imported_from_its_own_world(tmp_path):
    build_home(HomePlan(walls=WALLS, start=(2.0, 2.0)), tmp_path / "home")
    again = import_plan(tmp_path / "home/home.world")
    assert ("door", 2.0, 0.0, 0.9) in openings(again)
    assert rooms(again) == pytest.approx(rooms(HomePlan(walls=WALLS)), abs=0.1)


@pytest.mark.parametrize(("unit", "factor"), [(4, 1000.0), (6, 1.0), (1, 39.37007874)])
def test_a_dxf_drawing_becomes_walls_within_five_centimetres(unit, factor, tmp_path):
    dxf_of(WALLS, tmp_path / "house.dxf", unit, factor)
    plan = import_plan(tmp_path / "house.dxf")
    assert len(plan.walls) == 5
    for drawn in WALLS:
        found = min(
            plan.walls,
            key=lambda wall: math.dist(wall.point_at(wall.length / 2), drawn.point_at(drawn.length / 2)),
        )
        error = min(
            max(math.dist(found.start, a), math.dist(found.end, b))
            for a, b in ((drawn.start, drawn.end), (drawn.end, drawn.start))
        )
        assert error < 0.05
        assert found.thickness == pytest.approx(drawn.thickness, abs=1e-3)
    assert openings(plan) == [("door", 4.0, 2.0, 0.9), ("window", 6.0, 0.0, 1.5)]


def test_a_dxf_drawing_without_units_needs_a_scale(tmp_path):
    dxf_of(WALLS, tmp_path / "house.dxf", 0, 100.0)
    with pytest.raises(ImportPlanError, match="states no units; give --scale"):
        import_plan(tmp_path / "house.dxf")
    assert len(import_plan(tmp_path / "house.dxf", 0.01).walls) == 5


def test_an_ifc_model_becomes_walls_within_five_centimetres(tmp_path):
    ifc_of(WALLS, tmp_path / "house.ifc")
    plan = import_plan(tmp_path / "house.ifc")
    for drawn in WALLS:
        errors = [
            max(math.dist(found.start, a), math.dist(found.end, b))
            for found in plan.walls
            for a, b in ((drawn.start, drawn.end), (drawn.end, drawn.start))
        ]
        assert min(errors) < 0.05
    assert openings(plan) == [("door", 4.0, 2.0, 0.9), ("window", 6.0, 0.0, 1.5)]
    assert {wall.height for wall in plan.walls} == {2.5}
    build_home(plan, tmp_path / "home")


@pytest.mark.parametrize("name", ["plan.dxf", "plan.ifc", "plan.png", "plan.world", "plan.yaml"])
@pytest.mark.parametrize(
    "content", [b"", b"\0\1garbage\xff", b"ISO-10303-21;\nHEADER;\nEND", b"0\nSECTION\n2\n"]
)
def test_a_broken_file_is_refused_in_a_sentence(name, content, tmp_path):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(PlanarError, match=name):
        import_plan(tmp_path / name, 0.01 if name in ("plan.png", "plan.dxf") else None)


def test_the_source_of_a_home_is_a_file_a_plan_or_a_folder(tmp_path):
    plan = HomePlan(walls=WALLS, start=(2.0, 2.0))
    build_home(plan, tmp_path / "home")
    assert read_source(tmp_path / "home") == read_source(tmp_path / "home/plan.yaml") == plan
    assert (
        folder_of(tmp_path / "home", None)
        == folder_of(tmp_path / "home/plan.yaml", None)
        == tmp_path / "home"
    )
    assert folder_of(Path("flat.png"), None) == Path("homes/flat")
    (tmp_path / "letter.txt").write_text("dear")
    with pytest.raises(ImportPlanError, match="has other files and is no home"):
        folder_of(Path("flat.png"), tmp_path)
    with pytest.raises(ImportPlanError, match=r"letter.txt: unknown kind of file; expected one of .yaml"):
        import_plan(tmp_path / "letter.txt")
