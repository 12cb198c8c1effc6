"""DXF and IFC files and a picture of known walls."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Callable, Dict, List, Sequence, Tuple

import ezdxf
import ifcopenshell
import ifcopenshell.api
import numpy as np
from PIL import Image, ImageDraw

from home_builder import Opening, Wall

# A flat of four rooms and a hall: walls of three thicknesses, doors and windows.
FLAT = (
    Wall(
        (0.0, 0.0),
        (11.0, 0.0),
        0.3,
        openings=(Opening("window", 2.0, 1.5, 0.9, 2.1), Opening("window", 8.0, 2.0, 0.9, 2.1)),
    ),
    Wall((11.0, 0.0), (11.0, 8.0), 0.3, openings=(Opening("door", 4.0, 1.0),)),
    Wall((11.0, 8.0), (0.0, 8.0), 0.3, openings=(Opening("window", 3.0, 1.2, 0.9, 2.1),)),
    Wall((0.0, 8.0), (0.0, 0.0), 0.3),
    Wall((0.0, 3.2), (11.0, 3.2), 0.12, openings=(Opening("door", 2.5, 0.9), Opening("door", 8.0, 0.9))),
    Wall((0.0, 4.8), (11.0, 4.8), 0.12, openings=(Opening("door", 2.5, 0.9), Opening("door", 7.0, 0.8))),
    Wall((5.0, 0.0), (5.0, 3.2), 0.2),
    Wall((4.5, 4.8), (4.5, 8.0), 0.2, openings=(Opening("door", 1.6, 0.9),)),
)
MILLIMETRES, INCHES, METRES = (4, 1000.0), (1, 39.37007874), (6, 1.0)


def write_made_drawings(folder: Path) -> List[Path]:
    """Write a flat in several units and directions, and as an IFC model. Returns the files."""
    flat, turned, oblique = FLAT, turned_walls(FLAT, 30.0), turned_walls(FLAT, 7.5)
    drawings: Dict[str, Tuple[Callable, Sequence[Wall], Tuple]] = {
        "flat_mm.dxf": (dxf_of, flat, MILLIMETRES),
        "flat_inches.dxf": (dxf_of, flat, INCHES),
        "flat_turned_30.dxf": (dxf_of, turned, METRES),
        "flat.ifc": (ifc_of, flat, ()),
        "flat_turned_7.5.ifc": (ifc_of, oblique, ()),
    }
    for name, (write, walls, unit) in drawings.items():
        write(walls, folder / name, *unit)
    return [folder / name for name in drawings]


def turned_walls(walls: Sequence[Wall], degrees: float) -> List[Wall]:
    """Return walls turned about the origin."""
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

    def turned(point):
        return cos * point[0] - sin * point[1], sin * point[0] + cos * point[1]

    return [replace(wall, start=turned(wall.start), end=turned(wall.end)) for wall in walls]


def dxf_of(walls, path: Path, unit: int, factor: float) -> None:
    """Write the faces of walls, interrupted at doors, as pairs of lines."""
    document = ezdxf.new()
    document.units = unit
    space = document.modelspace()
    document.layers.add("A-WALL")
    for wall in walls:
        edges = sorted([0.0, wall.length, *(e for each in wall.openings for e in (each.first, each.last))])
        across = (-math.sin(wall.yaw) * wall.thickness / 2.0, math.cos(wall.yaw) * wall.thickness / 2.0)
        for first, last in zip(edges[::2], edges[1::2]):
            for side in (-1, 1):
                begin, end = (
                    np.add(wall.point_at(each), np.multiply(side, across)) * factor for each in (first, last)
                )
                space.add_line(begin, end, dxfattribs={"layer": "A-WALL"})
        for each in wall.openings:
            if each.kind == "window":
                begin, end = (np.multiply(wall.point_at(edge), factor) for edge in (each.first, each.last))
                space.add_line(begin, end, dxfattribs={"layer": "WINDOWS"})
    space.add_line((0, 0), (30 * factor, 30 * factor), dxfattribs={"layer": "DIMENSIONS"})
    document.saveas(path)


def ifc_of(walls, path: Path) -> None:
    """Write walls as extruded rectangles in millimetres, with openings that doors and windows fill."""
    run = ifcopenshell.api.run
    model = ifcopenshell.file(schema="IFC4")
    run("root.create_entity", model, ifc_class="IfcProject", name="house")
    run("unit.assign_unit", model)
    body = run("context.add_context", model, context_type="Model")
    body = run(
        "context.add_context",
        model,
        context_type="Model",
        context_identifier="Body",
        target_view="MODEL_VIEW",
        parent=body,
    )
    floor = run("root.create_entity", model, ifc_class="IfcBuildingStorey", name="ground")

    def product(kind, wall, first, last, bottom, top, thickness):
        made = run("root.create_entity", model, ifc_class=kind)
        matrix = np.eye(4)
        cos, sin = math.cos(wall.yaw), math.sin(wall.yaw)
        matrix[:2, :2] = [[cos, -sin], [sin, cos]]
        x, y = wall.point_at(first)
        matrix[:3, 3] = x + sin * thickness / 2.0, y - cos * thickness / 2.0, bottom
        run("geometry.edit_object_placement", model, product=made, matrix=matrix)
        shape = run(
            "geometry.add_wall_representation",
            model,
            context=body,
            length=last - first,
            height=top - bottom,
            thickness=thickness,
        )
        run("geometry.assign_representation", model, product=made, representation=shape)
        return made

    for wall in walls:
        made = product("IfcWall", wall, 0.0, wall.length, 0.0, wall.height, wall.thickness)
        run("spatial.assign_container", model, products=[made], relating_structure=floor)
        for each in wall.openings:
            hole = product("IfcOpeningElement", wall, each.first, each.last, each.bottom, each.top, 0.5)
            run("feature.add_feature", model, feature=hole, element=made)
            kind = "IfcDoor" if each.kind == "door" else "IfcWindow"
            filling = run("root.create_entity", model, ifc_class=kind)
            run("feature.add_filling", model, opening=hole, element=filling)
    model.write(str(path))


def draw_floor_plan(path: Path) -> None:
    """A floor plan as people draw it: thick walls, a door with its arc, a window of thin lines, text."""
    image = Image.new("L", (1000, 700), 255)
    draw = ImageDraw.Draw(image)

    def box(x1, y1, x2, y2):
        draw.rectangle([100 + x1 * 100, 600 - y2 * 100, 100 + x2 * 100 - 1, 600 - y1 * 100 - 1], fill=20)

    for x1, y1, x2, y2 in [(-0.1, -0.1, 5.25, 0.1), (6.75, -0.1, 8.1, 0.1), (-0.1, 4.9, 8.1, 5.1)]:
        box(x1, y1, x2, y2)
    for x1, y1, x2, y2 in [
        (-0.1, -0.1, 0.1, 5.1),
        (7.9, -0.1, 8.1, 5.1),
        (3.95, 0, 4.05, 1.55),
        (3.95, 2.45, 4.05, 5),
    ]:
        box(x1, y1, x2, y2)
    for offset in (-8, 0, 8):
        draw.line([625, 600 + offset, 775, 600 + offset], fill=60)
    draw.arc([410, 265, 590, 445], 90, 180, fill=80)
    draw.line([500, 445, 410, 445], fill=80)
    draw.text((250, 300), "Kitchen 18.3 m2", fill=0)
    image.save(path)
