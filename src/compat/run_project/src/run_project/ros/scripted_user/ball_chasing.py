"""Go Chase It: a white ball is put before the robot's camera, and taken away."""

import math
from functools import partial
from typing import TYPE_CHECKING, Optional, Tuple

import rospy
from gazebo_msgs.msg import ModelState, ModelStates
from gazebo_msgs.srv import SetModelState, SpawnModel
from geometry_msgs.msg import Pose

from planar import Pose2
from planar_ros.messages.conversion import quaternion_of

if TYPE_CHECKING:
    from run_project.ros.scripted_user.user import ScriptedUser

# Radians to the left of where the robot looks.
BEARINGS = (0.0, 0.35, -0.35)
# Metres to the ball, and from it to what is behind it; share of the way that the robot has to go.
MAX_BALL_DISTANCE, MIN_BALL_DISTANCE, BACKGROUND_CLEARANCE, DISTANCE_FRACTION = 2.0, 0.8, 0.4, 0.5
# Simulated seconds to chase it, and to stop without it.
CHASE_SECONDS, STOP_SECONDS = 30.0, 5.0
# Metres, in a second, below which a robot stands.
STOPPED_DISTANCE = 0.02
SERVICE_SECONDS = 30.0
RADIUS = 0.1
PARKING_COORDINATE = 500.0
_MATERIAL = "<material><diffuse>1 1 1 1</diffuse><emissive>1 1 1 1</emissive></material>"
_SHAPE = f"<geometry><sphere><radius>{RADIUS}</radius></sphere></geometry>"
BALL = f"""<sdf version="1.6"><model name="white_ball"><link name="link"><inertial><mass>1</mass></inertial>
<collision name="c">{_SHAPE}</collision><visual name="v">{_SHAPE}{_MATERIAL}</visual></link></model></sdf>"""


def check_ball_chasing(user: "ScriptedUser") -> None:
    """Places the ball ahead, to the left and to the right, and takes it away each time."""
    user.wait(lambda: user.has_node("process_image"), 120.0, "no process_image ran", is_wall=True)
    for service in ("set_model_state", "spawn_sdf_model"):
        rospy.wait_for_service(f"/gazebo/{service}", SERVICE_SECONDS)
    states = rospy.wait_for_message("/gazebo/model_states", ModelStates, SERVICE_SECONDS)
    robot = min(states.name, key=lambda name: _distance_to_model(states, name, user.base))
    ball = next((name for name in states.name if "ball" in name.lower() and name != robot), None)
    if ball is None:
        ball = _spawn_ball()
    _set_model_pose(ball, Pose2(PARKING_COORDINATE, PARKING_COORDINATE))
    _wait_until_stopped(user)
    stops = False
    for bearing in BEARINGS:
        for is_last in (False, True):
            is_chased, told = _place_ball(user, robot, ball, bearing)
            stops = _wait_until_stopped(user)
            if is_chased or is_last:
                user.add_check(is_chased, told)
                break
            user.log(f"{told}, once more")
    user.add_check(stops, "stands without it" if stops else "goes on without it")


def _place_ball(user: "ScriptedUser", robot: str, ball: str, bearing: float) -> Tuple[bool, str]:
    """Whether the robot goes for the ball, which is then taken away, and that in words.

    Where the machine is busy pictures come late, and a robot turns past the ball.
    """
    _turn_towards_free_space(user, robot, bearing)
    distance = max(
        min(MAX_BALL_DISTANCE, user.free_distance(bearing) - BACKGROUND_CLEARANCE), MIN_BALL_DISTANCE
    )
    at = user.base @ Pose2(distance * math.cos(bearing), distance * math.sin(bearing))
    _set_model_pose(ball, at)
    is_chased = user.wait(partial(_is_near, user, at, distance * DISTANCE_FRACTION), CHASE_SECONDS)
    left = user.base.distance_to(at)
    _set_model_pose(ball, Pose2(PARKING_COORDINATE, PARKING_COORDINATE))
    told = "chased" if is_chased else "did not chase"
    return is_chased, f"{told} the ball at {math.degrees(bearing):+.0f} deg: {distance:.1f} to {left:.1f} m"


def _is_near(user: "ScriptedUser", place: Pose2, near: float) -> bool:
    return user.base.distance_to(place) < near


def _wait_until_stopped(user: "ScriptedUser") -> bool:
    """Whether the robot stands still for a second, within a few."""
    deadline = rospy.get_time() + STOP_SECONDS
    while rospy.get_time() < deadline:
        before = user.base
        user.sleep(1.0)
        if user.base.distance_to(before) < STOPPED_DISTANCE:
            return True
    return False


def _turn_towards_free_space(user: "ScriptedUser", robot: str, bearing: float) -> None:
    """A robot that stands before a wall is turned by hand, as Gazebo's window lets one do."""
    if user.free_distance(bearing) < MIN_BALL_DISTANCE + BACKGROUND_CLEARANCE:
        turned = user.base @ Pose2(0.0, 0.0, user.bearing_with_most_space() - bearing)
        _set_model_pose(robot, turned, height=0.05)
        user.sleep(1.0)


def _distance_to_model(states: ModelStates, name: str, base: Pose2) -> float:
    position = states.pose[states.name.index(name)].position
    return math.hypot(position.x - base.x, position.y - base.y)


def _spawn_ball() -> str:
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = PARKING_COORDINATE, PARKING_COORDINATE, RADIUS
    pose.orientation.w = 1.0
    rospy.ServiceProxy("/gazebo/spawn_sdf_model", SpawnModel)("white_ball", BALL, "", pose, "world")
    return "white_ball"


def _set_model_pose(model: str, place: Pose2, height: Optional[float] = None) -> None:
    state = ModelState(model_name=model, reference_frame="world")
    position = state.pose.position
    position.x, position.y, position.z = place.x, place.y, RADIUS if height is None else height
    state.pose.orientation = quaternion_of(place.yaw)
    rospy.ServiceProxy("/gazebo/set_model_state", SetModelState)(state)
