"""Footprints of the meshes of Gazebo's models, used where these models are not installed."""

from typing import Dict, Optional, Tuple

import numpy as np

from sim_bridge.geometry.shapes import Mesh
from sim_bridge.sdf.shapes.prism import prism

# Measured on the meshes of github.com/osrf/gazebo_models at the height of a small robot; for people, whose
# meshes were not available, the plate below their feet. By the mesh's path after model://, in its own unit:
# bottom, top and the parts, each a circle (x, y, radius) or a rectangle (x_min, y_min, x_max, y_max).
Footprint = Tuple[float, float, Tuple[Tuple[float, ...], ...]]
_JERSEY_BARRIER: Footprint = (0.0, 1.05, ((-0.3, -0.87, 0.3, 0.87),))
_HATCHBACK: Footprint = (0.0, 61.0, ((-37.0, -92.0, 37.0, 64.0),))
FOOTPRINTS: Dict[str, Footprint] = {
    "construction_barrel/meshes/construction_barrel.dae": (0.0, 1.55, ((0.0, 0.0, 0.28),)),
    "construction_cone/meshes/construction_cone.dae": (0.0, 0.109, ((0.0, 0.0, 0.017),)),
    "cube_20k/meshes/cube_20k.stl": (-1.0, 1.0, ((-1.0, -1.0, 1.0, 1.0),)),
    "drc_practice_block_wall/meshes/block_wall.dae": (-0.31, 0.47, ((-0.94, -0.07, 0.65, 0.07),)),
    "drc_practice_blue_cylinder/meshes/cylinder.dae": (0.0, 0.86, ((-0.01, 0.0, 0.27),)),
    "drc_practice_orange_jersey_barrier/meshes/jersey_barrier.dae": _JERSEY_BARRIER,
    "drc_practice_white_jersey_barrier/meshes/jersey_barrier.dae": _JERSEY_BARRIER,
    "dumpster/meshes/dumpster.dae": (0.0, 1.18, ((-0.75, -0.48, 0.75, 0.48),)),
    "euro_pallet/meshes/pallet.dae": (-1.2, 0.2, ((-4.0, -6.0, 4.0, 5.8),)),
    "fire_hydrant/meshes/fire_hydrant.dae": (0.0, 0.93, ((0.0, -0.04, 0.16),)),
    "first_2015_trash_can/meshes/trash_can.dae": (0.0, 0.74, ((0.0, 0.0, 0.27),)),
    "fountain/meshes/fountain.dae": (0.0, 2.65, ((0.0, 0.0, 0.27),)),
    "hatchback/meshes/hatchback.obj": _HATCHBACK,
    "hatchback_blue/meshes/hatchback.obj": _HATCHBACK,
    "hatchback_red/meshes/hatchback.obj": _HATCHBACK,
    "lamp_post/meshes/lamp_post.dae": (0.0, 3.09, ((0.0, 0.01, 0.03),)),
    "mailbox/meshes/mailbox.dae": (0.0, 1.07, ((-0.02, -0.02, 0.02, 0.02),)),
    "oak_tree/meshes/oak_tree.dae": (-0.07, 6.53, ((-0.09, 0.1, 0.94),)),
    "person_standing/meshes/standing.dae": (0.0, 1.8, ((-0.25, -0.275, 0.25, 0.075),)),
    "person_walking/meshes/walking.dae": (0.0, 1.8, ((-0.175, -0.375, 0.175, 0.375),)),
    "pickup/meshes/pickup.dae": (0.0, 1.86, ((-1.08, -2.95, 1.08, 2.68),)),
    "pine_tree/meshes/pine_tree.dae": (0.0, 5.08, ((0.0, 0.0, 0.09),)),
    "polaris_ranger_ev/meshes/polaris.dae": (0.0, 1.96, ((-0.75, -1.2, 0.75, 1.31),)),
    "postbox/meshes/postbox.dae": (0.0, 1.52, ((-0.29, -0.3, 0.29, 0.3),)),
    "speed_limit_sign/meshes/speed_limit_sign.dae": (0.0, 0.236, ((-0.004, -0.005, 0.004, -0.002),)),
    "stop_light_post/meshes/stop_light_post.obj": (2.0, 601.0, ((-1.0, 0.0, 7.0),)),
    "stop_sign/meshes/stop_sign.dae": (0.0, 1.82, ((-0.03, -0.01, 0.03, 0.01),)),
    "suv/meshes/suv.obj": (0.0, 35.8, ((-19.5, -33.5, 18.4, 40.0),)),
    "table_marble/meshes/table_lightmap.dae": (
        *(-2.6, 1.3),
        ((-4.0, -3.4, -3.3, -2.9), (-4.0, 1.9, -3.2, 2.4), (3.3, -3.4, 4.0, -2.9), (3.3, 1.9, 4.0, 2.4)),
    ),
}
_ANGLES = np.radians(np.arange(0.0, 360.0, 30.0))


def footprint_of(uri: str, scale: Tuple[float, float, float]) -> Optional[Mesh]:
    """Return prisms over the footprint of a mesh; None if the mesh is not known.

    Args:
        uri: URI of the mesh.
        scale: Scale factors along x, y and z.
    """
    name = uri.partition("://")[2].lstrip("/")
    if name not in FOOTPRINTS:
        return None
    bottom, top, parts = FOOTPRINTS[name]
    prisms = [prism([_outline(part)], bottom, top) for part in parts]
    first = np.cumsum([0, *(len(each.vertices) for each in prisms)])
    vertices = np.vstack([each.vertices for each in prisms])
    triangles = np.vstack([each.triangles + offset for each, offset in zip(prisms, first)])
    return Mesh(vertices * scale, triangles)


def _outline(part: Tuple[float, ...]) -> np.ndarray:
    """Return the corners (N, 2) of a circle or rectangle."""
    if len(part) == 3:
        x, y, radius = part
        return np.column_stack([x + radius * np.cos(_ANGLES), y + radius * np.sin(_ANGLES)])
    x_min, y_min, x_max, y_max = part
    return np.array([[x_min, y_min], [x_max, y_min], [x_max, y_max], [x_min, y_max]])
