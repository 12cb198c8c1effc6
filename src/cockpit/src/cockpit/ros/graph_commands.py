"""Commands from the page to the graph: goals, poses, points, deliveries, time, models."""

import time
from typing import Any, Dict, List, Optional

import gazebo_msgs.msg
import gazebo_msgs.srv
import numpy as np
import rospy
from actionlib_msgs.msg import GoalID, GoalStatus
from geometry_msgs.msg import PointStamped, Pose, PoseStamped, PoseWithCovarianceStamped
from home_service_msgs.msg import DeliverActionGoal, DeliverActionResult, DeliverGoal, Delivery
from home_service_msgs.srv import AddDelivery, CancelDelivery
from sim_bridge_msgs.srv import Step
from std_srvs.srv import Empty

from cockpit.errors import CockpitError
from cockpit.frames import inverse, pose_from_message
from cockpit.models.pointing import quaternion_of
from cockpit.ros.calls import call, wait_for_subscribers
from cockpit.ros.graph import GraphClient
from rospy_transport.connections import is_connected

GOAL, ESTIMATE, POINT = "move_base_simple/goal", "initialpose", "clicked_point"
CANCEL = "move_base/cancel"
MISSIONS = "/pick_objects"
TWIST = "geometry_msgs/Twist"
# Ends of velocity topics in order of preference.
PREFERRED = ("input/teleop", "teleop/cmd_vel", "cmd_vel", "velocity")
# Variances of x, y and yaw that rviz publishes with a pose estimate.
VARIANCES = {0: 0.25, 7: 0.25, 35: 0.06853891945200942}
BOX_SIZE, BOX_HEIGHT = 0.3, 0.5
BOX = """<sdf version="1.6"><model name="{name}"><link name="box">
<inertial><mass>2</mass></inertial>
<collision name="box"><geometry><box><size>{size} {size} {size}</size></box></geometry></collision>
<visual name="box"><geometry><box><size>{size} {size} {size}</size></box></geometry>
<material><diffuse>0.85 0.55 0.2 1</diffuse></material></visual></link></model></sdf>"""


class GraphCommands:
    """Sends commands to the ROS graph.

    All methods raise CockpitError if the master does not answer, if there is no subscriber or service, or if
    the service fails.

    Args:
        graph: Client of the ROS graph.
    """

    def __init__(self, graph: GraphClient):
        self._graph = graph
        self._publishers: Dict[str, rospy.Publisher] = {}
        self._boxes = 0
        self._mission_id = ""

    def robots(self) -> List[str]:
        """Return the namespaces with a goal topic."""
        return sorted(name[: -len(GOAL)] for name in self._graph.subscribers() if name.endswith(f"/{GOAL}"))

    def velocity_topics(self) -> List[str]:
        """Return the velocity topics with a subscriber, preferred ones first."""
        types, own = self._graph.topics(), rospy.get_name()
        found = [
            name
            for name, nodes in self._graph.subscribers().items()
            if types.get(name) == TWIST and set(nodes) - {own}
        ]

        def rank(name: str) -> int:
            return next(
                (number for number, end in enumerate(PREFERRED) if name.endswith(end)), len(PREFERRED)
            )

        return sorted(found, key=lambda name: (rank(name), len(name), name))

    def goal(self, robot: str, frame: str, x: float, y: float, yaw: float) -> None:
        """Send a navigation goal (move_base_simple/goal).

        Args:
            robot: Namespace of the robot, ending with a slash.
            frame: Frame of the pose.
            x: Position [m].
            y: Position [m].
            yaw: Heading [rad].
        """
        message = PoseStamped(pose=_pose(x, y, yaw))
        message.header.frame_id, message.header.stamp = frame, rospy.get_rostime()
        self._send(robot + GOAL, message)

    def estimate(self, robot: str, frame: str, x: float, y: float, yaw: float) -> None:
        """Send a pose estimate with rviz's covariance (initialpose).

        Args:
            robot: Namespace of the robot, ending with a slash.
            frame: Frame of the pose.
            x: Position [m].
            y: Position [m].
            yaw: Heading [rad].
        """
        message = PoseWithCovarianceStamped()
        message.header.frame_id, message.header.stamp = frame, rospy.get_rostime()
        message.pose.pose = _pose(x, y, yaw)
        message.pose.covariance = [VARIANCES.get(index, 0.0) for index in range(36)]
        self._send(robot + ESTIMATE, message)

    def point(self, frame: str, x: float, y: float) -> None:
        """Publish a point on the floor (clicked_point).

        Args:
            frame: Frame of the point.
            x: Position [m].
            y: Position [m].
        """
        message = PointStamped()
        message.header.frame_id, message.header.stamp = frame, rospy.get_rostime()
        message.point.x, message.point.y = x, y
        self._send("/" + POINT, message, needs_subscriber=False)

    def cancel(self, robot: str) -> None:
        self._send(robot + CANCEL, GoalID())

    def places(self) -> List[str]:
        """Return the names of places of deliveries."""
        return list(self._graph.parameter(f"{MISSIONS}/places", []))

    def deliver(self, object_name: str, source: str, destination: str, joins: bool) -> None:
        """Request a delivery.

        Args:
            object_name: Name of the object.
            source: Place where it is picked up.
            destination: Place where it is dropped off.
            joins: Whether the delivery is added to the running mission; otherwise it starts one.
        """
        delivery = Delivery(object=object_name, source=source, destination=destination)
        if joins:
            _check(call(f"{MISSIONS}/add_delivery", AddDelivery, delivery))
            return
        goal = "/deliver/goal"
        if not self._graph.subscribers().get(goal):
            raise CockpitError(
                "no node accepts missions on /deliver/goal; start one with home_service.sh --serve"
            )
        message = DeliverActionGoal(goal=DeliverGoal(deliveries=[delivery]))
        self._mission_id = message.goal_id.id = f"{rospy.get_name()}-{time.time():.6f}"
        self._send(goal, message)

    def refusal(self, result: DeliverActionResult) -> str:
        """Return why the mission that was requested here was refused; empty for any other result."""
        is_own = result.status.goal_id.id == self._mission_id
        is_refused = result.status.status == GoalStatus.ABORTED and not result.result.deliveries
        return result.result.reason if is_own and is_refused else ""

    def cancel_mission(self) -> None:
        """Cancel all deliveries; a carried object is set down where the robot stands."""
        _check(call(f"{MISSIONS}/cancel_delivery", CancelDelivery, ""))

    def pause(self, is_paused: bool) -> None:
        call(f"/gazebo/{'pause' if is_paused else 'unpause'}_physics", Empty)

    def reset(self) -> None:
        call("/gazebo/reset_world", Empty)

    def step(self) -> None:
        call("/sim_bridge/step", Step, 1)

    def set_speed(self, factor: float) -> None:
        """Set the speed as a multiple of real time; 0 is as fast as possible."""
        physics = call("/gazebo/get_physics_properties", gazebo_msgs.srv.GetPhysicsProperties)
        answer = call(
            "/gazebo/set_physics_properties",
            gazebo_msgs.srv.SetPhysicsProperties,
            physics.time_step,
            factor / physics.time_step,
            physics.gravity,
            physics.ode_config,
        )
        _check(answer)

    def drop_box(self, x: float, y: float) -> str:
        """Spawn a box.

        Args:
            x: Position in the world frame [m].
            y: Position in the world frame [m].

        Returns:
            Name of its model.
        """
        self._boxes += 1
        name = f"box_of_cockpit_{int(time.time()) % 100000}_{self._boxes}"
        pose = _pose(x, y, 0.0)
        pose.position.z = BOX_HEIGHT
        answer = call(
            "/gazebo/spawn_sdf_model",
            gazebo_msgs.srv.SpawnModel,
            name,
            BOX.format(name=name, size=BOX_SIZE),
            "",
            pose,
            "world",
        )
        _check(answer)
        return name

    def move_model(self, name: str, x: float, y: float, yaw: Optional[float]) -> np.ndarray:
        """Move a model in the world frame.

        Args:
            name: Name of the model.
            x: New position [m].
            y: New position [m].
            yaw: New orientation [rad]; None keeps it.

        Returns:
            The motion (4, 4) in the world frame.
        """
        current = call("/gazebo/get_model_state", gazebo_msgs.srv.GetModelState, name, "world")
        _check(current)
        before = _matrix(current.pose)
        state = gazebo_msgs.msg.ModelState(model_name=name, reference_frame="world", pose=current.pose)
        if yaw is not None:
            state.pose = _pose(x, y, yaw)
        state.pose.position.x, state.pose.position.y, state.pose.position.z = x, y, before[2, 3]
        _check(call("/gazebo/set_model_state", gazebo_msgs.srv.SetModelState, state))
        return _matrix(state.pose) @ inverse(before)

    def set_joint(self, model: str, joint: str, position: float) -> None:
        """Set the position of a joint of a door or a drawer.

        Args:
            model: Name of the model.
            joint: Name of the joint in the model.
            position: Position [rad or m].
        """
        answer = call(
            "/gazebo/set_model_configuration",
            gazebo_msgs.srv.SetModelConfiguration,
            model,
            "robot_description",
            [joint],
            [position],
        )
        _check(answer)

    def _send(self, topic: str, message: Any, needs_subscriber: bool = True) -> None:
        if topic not in self._publishers:
            self._publishers[topic] = rospy.Publisher(topic, type(message), queue_size=1)
        publisher = self._publishers[topic]
        wait_for_subscribers(publisher)
        others = publisher.get_num_connections() - is_connected(publisher, rospy.get_name())
        if needs_subscriber and not others:
            raise CockpitError(f"no node subscribes to {topic}")
        publisher.publish(message)


def _check(answer: Any) -> None:
    if not answer.success:
        raise CockpitError(getattr(answer, "status_message", "") or getattr(answer, "message", ""))


def _pose(x: float, y: float, yaw: float) -> Pose:
    pose = Pose()
    pose.position.x, pose.position.y = x, y
    q = pose.orientation
    q.x, q.y, q.z, q.w = quaternion_of(yaw)
    return pose


def _matrix(pose: Pose) -> np.ndarray:
    """Return a pose as a matrix (4, 4). Raises CockpitError if it is invalid."""
    matrix = pose_from_message(pose.position, pose.orientation)
    if matrix is None:
        raise CockpitError("the simulator returned a pose that is not finite or has a zero quaternion")
    return matrix
