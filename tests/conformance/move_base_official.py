"""The official move_base on the cases of move_base_rig: one node for each set of parameters and map."""

import json
import os
import subprocess
import tempfile
import time
from typing import Any, Dict, List, Mapping, Optional, Tuple

import numpy as np
import rospy
import tf2_ros
from costmap_2d_official import START_SECONDS, end, find_executable, has_service, join_master, wait_until
from dynamic_reconfigure.msg import Config, ConfigDescription
from geometry_msgs.msg import PoseStamped, TransformStamped
from move_base_msgs.msg import MoveBaseActionResult, RecoveryStatus
from move_base_rig import FRAMES, PLAN_RESOLUTION, described, plan_parameters, with_frames
from nav_msgs.srv import GetPlan

from planar import grid_from_picture
from planar_ros.messages.conversion import OccupancyGridArrays, grid_to_msg

NODE = "/move_base"
MESSAGE_SECONDS, RECOVERY_SECONDS = 5.0, 30.0
WALLS = "\n".join(8 * [8 * "#"])
LARGEST_INT = 2**31 - 1


class _MoveBase:
    """One run of move_base, with transforms and, if given, a map."""

    def __init__(self, parameters: Mapping[str, Any], picture: str = ""):
        join_master()
        if rospy.has_param(NODE):
            rospy.delete_param(NODE)
        rospy.set_param(NODE, dict(parameters))
        self._tf = tf2_ros.StaticTransformBroadcaster()
        self._tf.sendTransform([_identity("map", "odom"), _identity("odom", "base_link")])
        self._map: Optional[rospy.Publisher] = None
        if picture:
            self._map = rospy.Publisher("map", OccupancyGridArrays, queue_size=1, latch=True)
            self._map.publish(
                grid_to_msg(grid_from_picture(picture, PLAN_RESOLUTION), rospy.Time.now(), "map")
            )
        self._log = tempfile.TemporaryFile()  # noqa: SIM115  -- open as long as the node runs
        command = [str(find_executable("move_base", "move_base")), "__name:=move_base"]
        self._process = subprocess.Popen(command, stdout=self._log, stderr=self._log, env=dict(os.environ))

    def __enter__(self) -> "_MoveBase":
        if not wait_until(lambda: has_service(f"{NODE}/set_parameters"), START_SECONDS):
            raise RuntimeError("move_base has not started: " + self.log[-300:])
        return self

    def __exit__(self, *error: Any) -> None:
        end(self._process)
        if self._map is not None:
            self._map.unregister()

    @property
    def log(self) -> str:
        """What the node has printed."""
        self._log.seek(0)
        return self._log.read().decode(errors="replace")


def _identity(parent: str, child: str) -> TransformStamped:
    transform = TransformStamped()
    transform.header.stamp, transform.header.frame_id = rospy.Time.now(), parent
    transform.child_frame_id, transform.transform.rotation.w = child, 1.0
    return transform


_offered: Dict[str, Dict[str, Dict[str, Tuple[Any, ...]]]] = {}


def parameters_of_official(given: Mapping[str, Any]) -> Tuple[Any, ...]:
    """Value and limits of a dynamic parameter of the official node."""
    parameters = with_frames(given.get("parameters", {}))
    key = json.dumps(parameters, sort_keys=True)
    servers = _offered.setdefault(key, {})
    if given["server"] not in servers:
        with _MoveBase(parameters):
            servers[given["server"]] = _read_server(given["server"])
    return servers[given["server"]].get(given["name"], ("not offered",))


def _read_server(server: str) -> Dict[str, Tuple[Any, ...]]:
    place = "/".join(filter(None, (NODE, server)))
    description = rospy.wait_for_message(
        f"{place}/parameter_descriptions", ConfigDescription, MESSAGE_SECONDS
    )
    update = rospy.wait_for_message(f"{place}/parameter_updates", Config, MESSAGE_SECONDS)
    found: Dict[str, Tuple[Any, ...]] = {each.name: (each.value,) for each in (*update.bools, *update.strs)}
    for kind in ("ints", "doubles"):
        low = {each.name: each.value for each in getattr(description.min, kind)}
        high = {each.name: each.value for each in getattr(description.max, kind)}
        for each in getattr(update, kind):
            found[each.name] = float(each.value), _limit(low[each.name]), _limit(high[each.name])
    return found


def _limit(value: float) -> Optional[float]:
    """The limit; None for none."""
    return None if abs(value) >= LARGEST_INT else float(value)


def recoveries_of_official(given: Mapping[str, Any]) -> List[str]:
    """Names of the recovery behaviors of the official node, which it reports as it runs them.

    Robot and goal are in a wall: there is no plan, and no room to rotate.
    """
    join_master()
    plugins = {"plugins": [{"name": "static", "type": "costmap_2d::StaticLayer"}]}
    parameters = {
        **given["parameters"],
        "planner_patience": 0.1,
        **{costmap: {**FRAMES, **plugins} for costmap in ("global_costmap", "local_costmap")},
    }
    names: List[str] = []
    results: List[MoveBaseActionResult] = []
    rospy.Subscriber("/move_base/recovery_status", RecoveryStatus, lambda each: names.append(_name(each)))
    rospy.Subscriber("/move_base/result", MoveBaseActionResult, results.append)
    goals = rospy.Publisher("/move_base_simple/goal", PoseStamped, queue_size=1)
    with _MoveBase(parameters, WALLS):
        wait_until(lambda: goals.get_num_connections() > 0, START_SECONDS)
        time.sleep(1.0)  # until it publishes to this process, too
        goals.publish(_pose((1.0, 1.0)))
        wait_until(lambda: bool(results), RECOVERY_SECONDS)
    goals.unregister()
    return names


def _name(status: RecoveryStatus) -> str:
    return str(status.recovery_behavior_name)


def plan_of_official(given: Mapping[str, Any]) -> Dict[str, Any]:
    """A plan of the official node, by ~make_plan."""
    with _MoveBase(plan_parameters(given), given["map"]):
        time.sleep(1.0)  # one update of the costmap
        call = rospy.ServiceProxy(f"{NODE}/make_plan", GetPlan)
        answer = call(_pose(given["start"]), _pose(given["goal"]), given.get("tolerance", 0.0))
    if not answer.plan.poses:
        return {"found": False}
    path_xy = np.array([(each.pose.position.x, each.pose.position.y) for each in answer.plan.poses])
    return described(path_xy, given)


def _pose(place: Any) -> PoseStamped:
    pose = PoseStamped()
    pose.header.frame_id = "map"
    pose.pose.position.x, pose.pose.position.y, pose.pose.orientation.w = *place[:2], 1.0
    return pose
