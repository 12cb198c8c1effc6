"""Pointing with the mouse on the floor as in rviz: press, drag, release."""

from typing import Any, Callable, Optional, Tuple

import numpy as np

from cockpit.drawing import LayerUpdate, LineSegments, PlacedShape
from cockpit.frames import pose_matrix
from cockpit.layers.poses import arrow
from cockpit.models.pointing import drag_yaw, floor_intersection, quaternion_of
from cockpit.page.scene_renderer import SceneRenderer

Point = Tuple[float, float]
PREVIEW, COLOUR, HEIGHT = "pointer", (46, 160, 67), 0.08


class FloorPointer:
    """Converts mouse clicks and drags on the floor to poses.

    Args:
        floor: Handle of the mesh that receives clicks.
        drawer: Draws the preview of the pose.
    """

    def __init__(self, floor: Any, drawer: SceneRenderer):
        self._floor, self._drawer = floor, drawer
        self._on_pose: Optional[Callable[[float, float, Optional[float], int], None]] = None
        self._start: Optional[Point] = None

    def aim(self, on_pose: Optional[Callable[[float, float, Optional[float], int], None]]) -> None:
        """Start or end pointing.

        Args:
            on_pose: Called with x, y [m] and yaw [rad] in the fixed frame, and the client id; the yaw is None
                for a click without a drag. None ends pointing: the mouse moves the camera again.
        """
        was_on, self._on_pose = self._on_pose is not None, on_pose
        if on_pose is not None and not was_on:
            self._floor.on_drag("left")(self._dragged)
            self._floor.on_click(self._clicked)
        if on_pose is None and was_on:
            self._floor.remove_drag_callback("all")
            self._floor.remove_click_callback("all")
            self._drawer.clear(PREVIEW)

    def _clicked(self, event: Any) -> None:
        if event.ray_origin is None or event.ray_direction is None or self._on_pose is None:
            return
        origin = np.asarray(event.ray_origin, float)
        hit = floor_intersection(origin, origin + np.asarray(event.ray_direction, float))
        if hit is not None:
            self._on_pose(*hit, None, event.client_id)

    def _dragged(self, event: Any) -> None:
        if event.phase == "start":
            self._start = event.start_position[0], event.start_position[1]
        start, end = self._start, floor_intersection(event.client.camera.position, event.end_position)
        if start is None:
            return
        yaw = drag_yaw(start, end, np.nan)
        if event.phase == "end":
            self._start = None
            self._drawer.clear(PREVIEW)
            if self._on_pose is not None:
                self._on_pose(*start, None if np.isnan(yaw) else yaw, event.client_id)
        elif not np.isnan(yaw):
            pose = pose_matrix((*start, HEIGHT), quaternion_of(yaw))
            lines = LineSegments(arrow(0.7, 0.2), COLOUR, 8.0)
            self._drawer.show(PREVIEW, LayerUpdate((PlacedShape("arrow", "", lines, pose),)))
