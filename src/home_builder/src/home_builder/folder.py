"""Builds the folder of a home from its plan."""

import io
import math
import tempfile
from pathlib import Path
from typing import Any, Dict, List, Mapping, Tuple

import yaml
from PIL import Image

from home_builder.errors import InvalidPlanError
from home_builder.plan.checks import problems_of
from home_builder.plan.file import plan_text
from home_builder.plan.frames import plan_in_world
from home_builder.plan.geometry import room_faces
from home_builder.plan.model import SPEED, HomePlan, Place
from home_builder.sdf import world_text
from home_builder.semantics import objects_text, semantic_map_of, semantic_map_text
from home_builder.standing import DROPOFF, PICKUP, all_places
from pick_objects import ErrandSettings
from planar import OccupancyGrid, save_map
from planar.errors import FileWriteError
from planar.files.reading import exists
from planar.files.writing import write_all_atomically
from planar.maps.home_folder import (
    IMAGE,
    MANIFEST,
    MAP,
    MISSION,
    NAVIGATION_ZONES,
    PICTURE,
    PLAN,
    WORLD,
    ZONES,
    changed_files,
    manifest_text,
)
from planar.maps.semantic_map import OBJECTS, SEMANTIC_MAP
from sim_bridge import load_world
from sim_bridge.views.top_view import render_top_view
from sim_bridge.views.true_map import true_map

# Files that people edit; edited ones are kept when the home is built again.
EDITABLE = (ZONES, MISSION, NAVIGATION_ZONES, SEMANTIC_MAP, OBJECTS)
RESOLUTION = 0.05
# Deliveries of the mission that is written, and digits of coordinates.
MOST_DELIVERIES, DIGITS = 3, 3
# Time for a goal, for each metre of the home's diagonal, which a path may exceed several times [s].
SECONDS_PER_METRE = 10.0


def build_home(plan: HomePlan, folder: Path) -> List[str]:
    """Write world, map, zones, mission, picture and manifest of a plan; all files or none.

    Args:
        plan: The plan.
        folder: Folder of the home; it is created. Zones and missions in it that were edited are kept.

    Returns:
        Remarks: the plan's warnings, and which files were kept.

    Raises:
        InvalidPlanError: The plan has errors; the text lists them with their points.
        PlanarError: A file cannot be read or written.
    """
    problems = problems_of(plan)
    errors = [str(problem) for problem in problems if problem.is_error]
    if errors:
        raise InvalidPlanError(errors)
    folder = Path(folder)
    kept = _edited(folder)
    contents = {**home_files(plan), **kept}
    contents[MANIFEST] = manifest_text(plan.name, contents).encode("utf-8")
    _make(folder)
    write_all_atomically({folder / name: [content] for name, content in contents.items()})
    if NAVIGATION_ZONES not in contents:
        (folder / NAVIGATION_ZONES).unlink(missing_ok=True)
    remarks = [str(problem) for problem in problems]
    return [*remarks, *(f"{folder / name}: kept, as it was edited" for name in kept)]


def _make(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileWriteError(f"{folder}: cannot be made ({error.strerror})") from None


def _edited(folder: Path) -> Dict[str, bytes]:
    if not exists(folder / MANIFEST):
        return {}
    return {name: content for name, content in changed_files(folder).items() if name in EDITABLE}


def home_files(plan: HomePlan) -> Dict[str, bytes]:
    """Return the files of a home without its manifest: content by name."""
    with tempfile.TemporaryDirectory(prefix="home_builder.") as temporary:
        folder = Path(temporary)
        (folder / WORLD).write_text(world_text(plan), encoding="utf-8")
        world = load_world(folder / WORLD)
        grid = true_map(world, resolution=RESOLUTION)
        save_map(grid, (folder / MAP).with_suffix(""))
        files = {name: (folder / name).read_bytes() for name in (WORLD, MAP, IMAGE)}
    files[PICTURE] = _png(render_top_view(world))
    files[PLAN] = plan_text(plan).encode("utf-8")
    return {**files, **_zone_files(plan, grid)}


def _png(pixels) -> bytes:
    content = io.BytesIO()
    Image.fromarray(pixels).save(content, "PNG")
    return content.getvalue()


def _zone_files(plan: HomePlan, grid: OccupancyGrid) -> Dict[str, bytes]:
    places, semantic_map = all_places(plan, grid), semantic_map_of(plan)
    files = {
        ZONES: _zones_text(places),
        MISSION: _mission_text(plan, places, grid),
        SEMANTIC_MAP: semantic_map_text(semantic_map),
        OBJECTS: objects_text(semantic_map, plan.name),
    }
    if plan.zones:
        files[NAVIGATION_ZONES] = _navigation_text(plan)
    return {name: text.encode("utf-8") for name, text in files.items()}


def _zones_text(places: Mapping[str, Place]) -> str:
    head = "# Places of the home by room and furniture, in the map frame: metres, radians.\n"
    return head + _table({name: _pose(place) for name, place in places.items()})


def _pose(place: Place) -> Dict[str, float]:
    entry = {"x": place.x, "y": place.y, "yaw": place.yaw, "radius": place.radius}
    return {key: round(value, DIGITS) + 0.0 for key, value in entry.items()}


def _table(entries: Mapping[str, Any]) -> str:
    return yaml.safe_dump(dict(entries), sort_keys=False, default_flow_style=None, allow_unicode=True)


def _mission_text(plan: HomePlan, places: Mapping[str, Place], grid: OccupancyGrid) -> str:
    """A tour of deliveries between rooms, the largest first, or from pick-up to drop-off."""
    rooms = [face.name for face in room_faces(plan) if face.name in places][: MOST_DELIVERIES + 1]
    stops = rooms if len(rooms) > 1 else [PICKUP, DROPOFF]
    names = ("cup", "book", "letter")
    deliveries = [
        {"object": name, "from": start, "to": end} for name, (start, end) in zip(names, _pairs(stops))
    ]
    head = "# Deliveries between the places of zones.yaml; docs/reference/missions.md explains every key.\n"
    patience = SECONDS_PER_METRE * math.hypot(grid.rows, grid.cols) * grid.resolution
    is_large = patience > ErrandSettings().goal_timeout
    settings = {"settings": {"goal_timeout": float(math.ceil(patience))}} if is_large else {}
    return head + _table({"name": plan.name, **settings, "deliveries": deliveries})


def _pairs(stops: List[str]) -> List[Tuple[str, str]]:
    return list(zip(stops, stops[1:]))


def _navigation_text(plan: HomePlan) -> str:
    entries: Dict[str, Dict[str, Any]] = {}
    for zone in plan_in_world(plan).zones:
        corners = [[round(x, DIGITS), round(y, DIGITS)] for x, y in zone.corners]
        entries[zone.name] = {"kind": zone.kind, "corners": corners}
        if zone.kind == SPEED:
            entries[zone.name]["max_speed"] = zone.max_speed
    return "# Keep-out and speed zones of move_base.\n" + _table(entries)
