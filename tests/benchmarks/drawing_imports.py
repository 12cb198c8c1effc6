#!/usr/bin/env python3
"""Walls that are imported from IFC and DXF files, compared with the drawings themselves.

    python3 tests/benchmarks/drawing_imports.py FILE[=SCALE]... [--made] [--json FILE] [--pictures FOLDER]

For each file: the walls; the share of their faces that lie within 0.05 m of what is drawn, and the share of
what is drawn that has a face within 0.05 m. Faces are those 0.3 m above the floor, with doors open. What is
drawn is, of an IFC file, a cut through the meshes that IfcOpenShell makes of its walls; of a DXF file, the
lines on its layers of walls, or all of its lines if it has no such layer. --made adds files of known walls in
several units and directions. SCALE is the size of a unit of a DXF file that states none, or a wrong one [m].
"""

import argparse
import json
import math
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Tuple

import ifcopenshell.geom
import numpy as np
import shapely
from made_drawings import write_made_drawings
from PIL import Image, ImageDraw
from shapely.geometry import LineString, MultiLineString, Polygon

from home_builder import Wall
from home_builder.imports import import_plan
from home_builder.imports.dxf import drawn_segments
from home_builder.imports.ifc import walls_of_floor
from home_builder.plan.geometry import furniture_polygon, solid_polygons
from home_builder.plan.model import DOOR
from planar import PlanarError

# Largest error [m], distance between two points that are compared [m], height of the cut above the floor [m].
WITHIN, STEP, CUT = 0.05, 0.02, 0.3
PICTURE_PIXELS = 700


def main() -> int:
    options = _options()
    rows: List[Dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as folder:
        made = write_made_drawings(Path(folder)) if options.made else []
        for text in [*options.files, *map(str, made)]:
            name, _, scale = text.partition("=")
            path = Path(name)
            rows.append({"file": path.name, **_row(path, float(scale) if scale else None, options.pictures)})
            print("  ".join(f"{key} {value}" for key, value in rows[-1].items()), flush=True)
    if options.json is not None:
        options.json.write_text(json.dumps(rows, indent=1), encoding="utf-8")
    good = sum(row.get("faces_within", 0.0) >= 0.95 for row in rows)
    print(f"{good} of {len(rows)} files: at least 0.95 of the faces of walls within {WITHIN} m")
    return 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("files", nargs="*", metavar="FILE[=SCALE]")
    parser.add_argument("--made", action="store_true", help="also files that are made here")
    parser.add_argument("--json", type=Path, help="also write the rows to this file")
    parser.add_argument("--pictures", type=Path, help="folder for a picture of each import")
    return parser.parse_args()


def _row(path: Path, scale: Optional[float], pictures: Optional[Path]) -> Dict[str, Any]:
    try:
        plan = import_plan(path, scale)
    except PlanarError as error:
        return {"error": str(error)}
    is_model = path.suffix == ".ifc"
    drawn = _ifc_lines(path) if is_model else _dxf_lines(path, scale)
    # The faces of walls are drawn in models below windows as well, in drawings beside them only.
    walls = plan.walls if is_model else map(_with_doors, plan.walls)
    faces = shapely.union_all(solid_polygons(tuple(walls))).boundary
    solids = shapely.union_all([faces, *(furniture_polygon(piece).boundary for piece in plan.furniture)])
    if pictures is not None:
        pictures.mkdir(parents=True, exist_ok=True)
        _picture(drawn, faces).save(pictures / f"{path.stem}.png")
    openings = sum(len(wall.openings) for wall in plan.walls)
    return {
        "walls": len(plan.walls),
        "openings": openings,
        "faces_within": round(_share_within(faces, drawn), 4),
        "drawn_within": round(_share_within(drawn, solids), 4),
    }


def _with_doors(wall: Wall) -> Wall:
    return replace(wall, openings=tuple(replace(each, kind=DOOR, bottom=0.0) for each in wall.openings))


def _share_within(lines, others) -> float:
    """Return the share of the length of lines that is near to others."""
    points = shapely.points([xy for line in _parts(lines) for xy in _points_along(line)])
    return float((shapely.distance(points, others) <= WITHIN).mean())


def _parts(lines) -> Iterator[LineString]:
    yield from getattr(lines, "geoms", [lines])


def _points_along(line: LineString) -> Iterator[Tuple[float, float]]:
    for distance in np.linspace(0.0, line.length, max(2, math.ceil(line.length / STEP))):
        yield line.interpolate(distance).coords[0]


def _dxf_lines(path: Path, scale: Optional[float]) -> MultiLineString:
    return MultiLineString([list(each) for each in drawn_segments(path, scale)])


def _ifc_lines(path: Path):
    """Cut the meshes of the walls of a floor, with their openings, above their lowest points."""
    model = ifcopenshell.open(str(path))
    settings = ifcopenshell.geom.settings()
    settings.set("use-world-coords", True)
    meshes = []
    for wall in walls_of_floor(model):
        try:
            shape: Any = ifcopenshell.geom.create_shape(settings, wall)  # kept, as it owns its geometry
        except RuntimeError:
            continue
        points = np.array(shape.geometry.verts).reshape(-1, 3)
        meshes.append(points[np.array(shape.geometry.faces).reshape(-1, 3)])
    bottoms = [round(float(mesh[..., 2].min()), 2) for mesh in meshes]
    height = max(set(bottoms), key=bottoms.count) + CUT
    areas = [_cut(mesh, height) for mesh in meshes]
    return shapely.union_all(areas).boundary


def _cut(triangles: np.ndarray, height: float):
    """Return the area in which triangles (N, 3, 3) that enclose a solid are cut at a height."""
    segments = []
    for triangle in triangles:
        above = triangle[:, 2] > height
        if above.all() or not above.any():
            continue
        ends = []
        for one, other in ((0, 1), (1, 2), (2, 0)):
            if above[one] != above[other]:
                share = (height - triangle[one, 2]) / (triangle[other, 2] - triangle[one, 2])
                ends.append(
                    np.round(triangle[one, :2] + share * (triangle[other, :2] - triangle[one, :2]), 5)
                )
        segments.append(LineString(ends))
    faces = shapely.polygonize([shapely.union_all(segments)]) if segments else Polygon()
    return shapely.union_all(list(getattr(faces, "geoms", [])))


def _picture(drawn, faces) -> Image.Image:
    """Draw what is drawn in grey, and the faces of the imported walls in red."""
    low_x, low_y, high_x, high_y = shapely.union_all([faces, drawn]).bounds
    scale = PICTURE_PIXELS / max(high_x - low_x, high_y - low_y)
    size = [int((high_x - low_x) * scale) + 21, int((high_y - low_y) * scale) + 21]
    image = Image.new("RGB", size, "white")
    pen = ImageDraw.Draw(image)
    for lines, colour, width in ((drawn, (170, 170, 170), 5), (faces, (200, 0, 0), 1)):
        for line in _parts(lines):
            corners = [(10 + (x - low_x) * scale, size[1] - 10 - (y - low_y) * scale) for x, y in line.coords]
            pen.line(corners, fill=colour, width=width)
    return image


if __name__ == "__main__":
    sys.exit(main())
