"""Solid objects of a mission as boxes in the simulator, moved by Gazebo's services."""

from typing import Dict, Optional, Sequence

import rospy
from gazebo_msgs.srv import (
    DeleteModel,
    DeleteModelRequest,
    GetModelState,
    GetModelStateRequest,
    SpawnModel,
    SpawnModelRequest,
)
from gazebo_ros_link_attacher.srv import Attach, AttachRequest
from geometry_msgs.msg import Pose
from home_service_msgs.msg import ObjectState
from std_msgs.msg import ColorRGBA

from add_markers.boxes import HEIGHT, MASS, RIDING_HEIGHT, PlaceBox, SolidBox
from add_markers.config import MarkerSettings
from add_markers.mission_boxes import MissionBoxes
from planar import Pose2
from planar_ros.calls.services import ServiceError, call_service
from planar_ros.messages.conversion import OccupancyGridArrays, grid_from_msg, pose2_from_msg, pose2_to_msg
from planar_ros.messages.validation import subscribe

START_SECONDS, ANSWER_SECONDS = 20.0, 5.0
LINK = "link"
BOX = f"""
<sdf version="1.6"><model name="box"><link name="{LINK}">
  <gravity>{{has_weight}}</gravity><inertial><mass>{MASS}</mass></inertial>
  <collision name="box"><geometry><box><size>{{size}} {{size}} {HEIGHT}</size></box></geometry></collision>
  <visual name="box"><geometry><box><size>{{size}} {{size}} {HEIGHT}</size></box></geometry>
    <material><diffuse>{{color.r}} {{color.g}} {{color.b}} 1</diffuse></material></visual>
</link></model></sdf>"""


class SimulatedBoxes:
    """Moves the boxes as the mission proceeds; without a simulator it logs a warning and stops."""

    def __init__(self, settings: MarkerSettings):
        self._gazebo = GazeboBoxes(settings.robot_model, settings.base_frame_id)
        self._boxes = MissionBoxes(self._gazebo)
        self._is_connected = self._has_failed = False
        subscribe("map", OccupancyGridArrays, self._on_map, queue_size=1)

    def follow(self, objects: Sequence[ObjectState]) -> Dict[str, Pose2]:
        """Move the boxes to where they belong.

        Args:
            objects: State of all objects of the mission.

        Returns:
            Poses of the boxes on the floor, by name.
        """
        solids = [_solid_of(state) for state in objects if state.is_solid]
        self._gazebo.colors = {state.name: state.color for state in objects}
        if not self._has_failed and (solids or self._is_connected):
            try:
                if not self._is_connected:
                    rospy.wait_for_service("/gazebo/get_model_state", START_SECONDS)
                    self._is_connected = True
                self._boxes.update(solids)
            except (ServiceError, rospy.ROSException) as error:
                rospy.logwarn("solid objects are shown as markers only, no simulator answers: %s", error)
                self._has_failed = True
        return self._boxes.placed

    def room_beside(self, robot: Pose2, size: float) -> Pose2:
        """Return a free pose next to the robot in the map, for an object of that width [m]."""
        return self._boxes.room_beside(robot, size)

    def _on_map(self, message) -> None:
        self._boxes.set_map(grid_from_msg(message))


class GazeboBoxes:
    """Boxes in a simulator with Gazebo's services.

    Args:
        robot: Model of the robot.
        base: Link of the robot to which boxes are attached.

    Attributes:
        colors: Colors of the boxes, by name.
    """

    def __init__(self, robot: str, base: str):
        self._robot, self._base = robot, base
        self.colors: Dict[str, ColorRGBA] = {}

    def robot_in_world(self) -> Pose2:
        request = GetModelStateRequest(self._robot, "world")
        return pose2_from_msg(_ask("get_model_state", GetModelState, request).pose)

    def remove(self, name: str) -> None:
        _ask("delete_model", DeleteModel, DeleteModelRequest(name))

    def spawn(self, order: PlaceBox) -> None:
        """Spawn a box; one without gravity stays in place until it is attached to the robot."""
        name, size, is_riding = order.solid.name, order.solid.size, order.pose is None
        box = BOX.format(size=size, has_weight=int(not is_riding), color=self.colors[name])
        pose: Pose = pose2_to_msg(order.pose or Pose2())
        pose.position.z = HEIGHT / 2.0 + (RIDING_HEIGHT if is_riding else 0.0)
        frame = self._robot if is_riding else "world"
        _ask("spawn_sdf_model", SpawnModel, SpawnModelRequest(name, box, "", pose, frame))
        if is_riding:
            request = AttachRequest(self._robot, self._base, name, LINK)
            if not call_service("/link_attacher_node/attach", Attach, request, ANSWER_SECONDS).ok:
                raise ServiceError(f"{name} cannot be attached to {self._robot}::{self._base}")


def _solid_of(state: ObjectState) -> SolidBox:
    pose: Optional[Pose2] = None if state.is_carried else pose2_from_msg(state.pose)
    return SolidBox(state.name, state.size, pose)


def _ask(name: str, kind, request):
    """Call one of Gazebo's services.

    Raises:
        ServiceError: If it does not answer or refuses.
    """
    response = call_service(f"/gazebo/{name}", kind, request, ANSWER_SECONDS)
    if not response.success:
        raise ServiceError(response.status_message)
    return response
