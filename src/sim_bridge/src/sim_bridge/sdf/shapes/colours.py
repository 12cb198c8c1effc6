"""Reads the colours of <material> elements."""

from typing import Optional

from sim_bridge.sdf.element import Element
from sim_bridge.world import DARK, Colour

DEFAULT: Colour = (0.7, 0.7, 0.7)
# Gazebo's materials by name: diffuse colour, or mean colour of the texture.
NAMED = {
    "Grey": (0.7, 0.7, 0.7),
    "DarkGrey": (0.175, 0.175, 0.175),
    "White": (1.0, 1.0, 1.0),
    "FlatBlack": (0.1, 0.1, 0.1),
    "Black": (0.0, 0.0, 0.0),
    "Red": (1.0, 0.0, 0.0),
    "RedBright": (0.87, 0.26, 0.07),
    "Green": (0.0, 1.0, 0.0),
    "Blue": (0.0, 0.0, 1.0),
    "SkyBlue": (0.13, 0.44, 0.70),
    "Yellow": (1.0, 1.0, 0.0),
    "DarkYellow": (0.7, 0.7, 0.0),
    "Purple": (1.0, 0.0, 1.0),
    "Turquoise": (0.0, 1.0, 1.0),
    "Orange": (1.0, 0.51, 0.05),
    "DarkOrange": (0.83, 0.32, 0.08),
    "Gold": (0.8, 0.65, 0.0),
    "Indigo": (0.33, 0.0, 0.5),
    "ZincYellow": (0.97, 0.95, 0.32),
    "Wood": (0.60, 0.45, 0.30),
    "WoodFloor": (0.60, 0.45, 0.30),
    "WoodPallet": (0.65, 0.55, 0.40),
    "LightWood": (0.75, 0.62, 0.45),
    "Bricks": (0.55, 0.33, 0.27),
    "CeilingTiled": (0.85, 0.85, 0.83),
    "PaintedWall": (0.85, 0.83, 0.78),
    "Residential": (0.75, 0.70, 0.62),
    "Grass": (0.30, 0.45, 0.20),
    "Road": (0.30, 0.30, 0.30),
    "Asphalt": (0.30, 0.30, 0.30),
    "Pioneer2Body": (0.6, 0.0, 0.0),
}


def read_colour(visual: Element) -> Optional[Colour]:
    """Return the diffuse, ambient or scripted colour of a <visual>, None if it has none."""
    for tag in ("diffuse", "ambient"):
        element = visual.child("material", tag)
        if element is not None:
            return _colour(element)
    name = visual.child("material", "script", "name")
    return NAMED.get(name.text.rsplit("/", 1)[-1], DEFAULT) if name is not None else None


def read_emissive(visual: Element) -> Colour:
    """Return the emissive colour of a <visual>."""
    element = visual.child("material", "emissive")
    return DARK if element is None else _colour(element)


def _colour(element: Element) -> Colour:
    count = min(max(len(element.text.split()), 3), 4)
    red, green, blue, *_ = (min(max(number, 0.0), 1.0) for number in element.numbers(count))
    return (red, green, blue)
