"""Services of gazebo_ros_link_attacher: attach links to each other and detach them."""

from typing import Callable

import rospy
from gazebo_ros_link_attacher.srv import Attach, AttachResponse

from sim_bridge.errors import UnknownEntityError
from sim_bridge.ros.gazebo.server import GazeboServer
from sim_bridge.scene import Scene


class AttachServices:
    def __init__(self, scene: Scene, server: GazeboServer):
        server.serve("/link_attacher_node/attach", Attach, lambda request: _call(scene.attach, request))
        server.serve("/link_attacher_node/detach", Attach, lambda request: _call(scene.detach, request))


def _call(change: Callable[[str, str], None], request) -> AttachResponse:
    first = f"{request.model_name_1}::{request.link_name_1}"
    second = f"{request.model_name_2}::{request.link_name_2}"
    try:
        change(first, second)
    except UnknownEntityError as error:
        rospy.logwarn("%s and %s: %s", first, second, error)
        return AttachResponse(False)
    return AttachResponse(True)
