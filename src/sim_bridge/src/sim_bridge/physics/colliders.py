"""Creates Bullet collision shapes."""

from typing import Any, Dict, List, Sequence, Tuple

import numpy as np

from sim_bridge.geometry.pose3 import inverse, position, quaternion, transform_points
from sim_bridge.geometry.shapes import Box, Cylinder, Mesh, Plane, Shape, Sphere
from sim_bridge.physics.bullet import BulletClient, pybullet
from sim_bridge.world import Collision

# Bullet's limits: shapes per compound, and triangles per mesh (three vertices each, of at most 131072).
COMPOUND_SIZE = 16
MESH_SIZE = 40000
NO_SHAPE = -1


def make_colliders(
    bullet: BulletClient, collisions: Sequence[Collision], moves: bool, origin: np.ndarray
) -> List[int]:
    """Create the Bullet shapes of a body's collisions.

    Args:
        bullet: The physics engine.
        collisions: The solid parts of the body.
        moves: Whether physics moves the body; its meshes are then replaced by their convex hulls.
        origin: Pose (4, 4), in the body frame, of the frame in which the shapes are created.

    Returns:
        Bullet's shape ids, at least one: NO_SHAPE for a body without collisions.
    """
    to_origin = inverse(origin)
    placed = [(part.shape, to_origin @ part.pose_in_body) for part in collisions]
    meshes = [(shape, pose) for shape, pose in placed if isinstance(shape, Mesh)]
    solids = [(shape, pose) for shape, pose in placed if not isinstance(shape, Mesh)]
    groups = [solids[at : at + COMPOUND_SIZE] for at in range(0, len(solids), COMPOUND_SIZE)]
    shape_ids = [_compound(bullet, group) for group in groups]
    shape_ids += [shape_id for mesh, pose in meshes for shape_id in _mesh(bullet, mesh, pose, moves)]
    return shape_ids or [NO_SHAPE]


def _compound(bullet: BulletClient, group: Sequence[Tuple[Shape, np.ndarray]]) -> int:
    if len(group) == 1:
        ((shape, pose),) = group
        return bullet.createCollisionShape(
            **_arguments(shape),
            collisionFramePosition=position(pose),
            collisionFrameOrientation=quaternion(pose),
        )
    parts = [{**_UNUSED_ARGUMENTS, **_arguments(shape)} for shape, _ in group]
    return bullet.createCollisionShapeArray(
        shapeTypes=[part["shapeType"] for part in parts],
        radii=[part["radius"] for part in parts],
        halfExtents=[part["halfExtents"] for part in parts],
        lengths=[part["height"] for part in parts],
        planeNormals=[part["planeNormal"] for part in parts],
        collisionFramePositions=[position(pose) for _, pose in group],
        collisionFrameOrientations=[quaternion(pose) for _, pose in group],
    )


def _mesh(bullet: BulletClient, mesh: Mesh, pose: np.ndarray, moves: bool) -> List[int]:
    """Create a concave mesh, in pieces, of a static body; the convex hull of one that moves."""
    vertices = transform_points(pose, mesh.vertices)
    if moves:
        from scipy.spatial import ConvexHull  # late: few worlds have meshes

        hull = vertices[ConvexHull(vertices, qhull_options="QJ").vertices]
        return [bullet.createCollisionShape(pybullet.GEOM_MESH, vertices=hull.tolist())]
    pieces = []
    for at in range(0, len(mesh.triangles), MESH_SIZE):
        used, indices = np.unique(mesh.triangles[at : at + MESH_SIZE], return_inverse=True)
        pieces.append(
            bullet.createCollisionShape(
                pybullet.GEOM_MESH,
                vertices=vertices[used].tolist(),
                indices=indices.ravel().tolist(),
                flags=pybullet.GEOM_FORCE_CONCAVE_TRIMESH,
            )
        )
    return pieces


_UNUSED_ARGUMENTS: Dict[str, Any] = {
    "radius": 1.0,
    "halfExtents": [1.0, 1.0, 1.0],
    "height": 1.0,
    "planeNormal": [0.0, 0.0, 1.0],
}


def _arguments(shape: Shape) -> Dict[str, Any]:
    if isinstance(shape, Box):
        return {"shapeType": pybullet.GEOM_BOX, "halfExtents": [length / 2.0 for length in shape.size]}
    if isinstance(shape, Cylinder):
        return {"shapeType": pybullet.GEOM_CYLINDER, "radius": shape.radius, "height": shape.length}
    if isinstance(shape, Sphere):
        return {"shapeType": pybullet.GEOM_SPHERE, "radius": shape.radius}
    if isinstance(shape, Plane):
        return {"shapeType": pybullet.GEOM_PLANE, "planeNormal": list(shape.normal)}
    raise TypeError(f"not a primitive shape: {shape}")
